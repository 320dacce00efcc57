// The pair of rollers to scale.

import { svg } from "./dom.js";
import { toneOf } from "./palette.js";
import { sheetInPair } from "./sheetdrawing.js";
import { say } from "./texts.js";

const TYPE = "Inter, 'Segoe UI', system-ui, sans-serif";
const MARGIN = 16;

/** An empty picture of some pixels, on its ground. */
export function picture(width, height, label, palette) {
  const node = svg("svg", {
    viewBox: `0 0 ${width} ${height}`,
    width,
    height,
    role: "img",
    "aria-label": label,
    "font-family": TYPE,
  });
  node.append(svg("rect", { width, height, fill: palette.air }));
  return node;
}

/** A line of text. */
export function words(x, y, text, { size = 12, anchor = "middle", fill, weight = 400 } = {}) {
  return svg("text", { x, y, "font-size": size, "text-anchor": anchor, fill, "font-weight": weight, text });
}

/** Both rollers whole. `nip` is {approach}; `zoom` the half-width of the frame around the nip [mm]. */
export function pairPicture(tree, nip, zoom, { width, height, palette, units }) {
  const label = describe(tree, units);
  const node = picture(width, height, label, palette);
  const frame = fit(tree, width, height);
  for (const side of ["lower", "upper"]) node.append(roller(side, tree, nip, frame, palette));
  const level = frame.y + 0.5 * (nip.approach ?? 0) * frame.scale;
  if (tree.sheet) node.append(sheetInPair(level, width, palette));
  node.append(...turns(tree, nip, frame, palette));
  const half = Math.max(3, zoom * frame.scale);
  const box = { x: frame.x - half, y: frame.y - 0.62 * half, width: 2 * half, height: 1.24 * half };
  node.append(
    svg("rect", {
      ...box,
      fill: "none",
      stroke: palette.ink,
      "stroke-width": 1.3,
      "stroke-dasharray": "3 2",
    }),
  );
  return node;
}

function describe(tree, units) {
  const one = (side) => {
    const { radius, layers } = tree[side];
    const size = radius === "inf" ? say("body.plane") : say("drawing.diameter", { size: units.text(2 * radius, "length") });
    const covers = layers.map((layer) => units.text(layer.thickness, "length"));
    return say("drawing.roller", {
      side: say(`side.${side}`),
      size,
      covers: covers.length ? say("drawing.layers", { layers: covers.join(", ") }) : say("drawing.bare"),
    });
  };
  return say("drawing.label", { upper: one("upper"), lower: one("lower") });
}

/** Scale [px/mm] and the place of the nip in the picture. */
function fit(tree, width, height) {
  const [upper, lower] = ["upper", "lower"].map((side) => sizeOf(tree, side));
  const scale = Math.min(
    (width - 2 * MARGIN) / (2 * Math.max(upper, lower)),
    (height - 2 * MARGIN) / (2 * (upper + lower)),
  );
  const rest = height - 2 * scale * (upper + lower);
  return { scale, x: width / 2, y: rest / 2 + 2 * scale * upper, width, height };
}

/** A radius for the picture; a plane takes as much room as half its roller. */
function sizeOf(tree, side) {
  const other = side === "upper" ? "lower" : "upper";
  const { radius } = tree[side];
  return radius === "inf" ? 0.35 * tree[other].radius : radius;
}

function roller(side, tree, nip, frame, palette) {
  const { radius, layers } = tree[side];
  const up = side === "upper" ? -1 : 1;
  const shift = side === "upper" ? (nip.approach ?? 0) * frame.scale : 0;
  const top = frame.y + shift;
  const shape = svg("g", { stroke: palette.coreEdge, "stroke-width": 0.6 });
  let depth = 0;
  const bands = [
    ...layers.map((layer, i) => [layer.thickness, toneOf(side, i, palette)]),
    [0, palette.core],
  ];
  for (const [thickness, fill] of bands) {
    const at = top + up * depth * frame.scale;
    if (radius === "inf") shape.append(slab(at, up, frame, fill));
    else if (radius > depth)
      shape.append(
        svg("circle", {
          cx: frame.x,
          cy: top + up * radius * frame.scale,
          r: (radius - depth) * frame.scale,
          fill,
        }),
      );
    depth += thickness;
  }
  return shape;
}

function slab(at, up, frame, fill) {
  const height = up < 0 ? at : frame.height - at;
  return svg("rect", { x: 0, y: up < 0 ? 0 : at, width: frame.width, height: Math.max(0, height), fill });
}

/** An arrow of turning and the name in each roller. */
function turns(tree, nip, frame, palette) {
  const found = [];
  for (const side of ["upper", "lower"]) {
    const { radius } = tree[side];
    const up = side === "upper" ? -1 : 1;
    const size = sizeOf(tree, side);
    const cy = frame.y + up * size * frame.scale;
    const bare =
      radius === "inf"
        ? 0
        : Math.max(0.15, 1 - tree[side].layers.reduce((sum, layer) => sum + layer.thickness, 0) / radius);
    const r = 0.62 * bare * size * frame.scale;
    if (r > 15) found.push(arc(frame.x, cy, r, up, palette));
    if (r > 22) found.push(words(frame.x, cy + 4, say(`place.${side}`), { fill: palette.ink, size: r > 30 ? 12.5 : 11 }));
  }
  return found;
}

/** A circular arrow: at the nip both surfaces move to the left, from inlet to outlet. */
function arc(cx, cy, r, up, palette) {
  const turn = up < 0 ? 1 : -1; // clockwise above
  const at = (angle) => [cx + r * Math.cos(angle), cy + r * Math.sin(angle)];
  const [from, to] = [-Math.PI / 2 - 0.9 * turn, -Math.PI / 2 + 0.9 * turn].map((angle) =>
    up < 0 ? angle : angle + Math.PI,
  );
  const [x0, y0] = at(from);
  const [x1, y1] = at(to);
  const ahead = to + (turn * Math.PI) / 2;
  const tip = (side) => `${x1 - 8 * Math.cos(ahead + side)} ${y1 - 8 * Math.sin(ahead + side)}`;
  const path = `M${x0} ${y0}A${r} ${r} 0 0 ${turn > 0 ? 1 : 0} ${x1} ${y1}M${tip(0.5)}L${x1} ${y1}L${tip(-0.5)}`;
  return svg("path", {
    d: path,
    fill: "none",
    stroke: palette.ink,
    "stroke-width": 1.4,
    "stroke-linecap": "round",
    "stroke-linejoin": "round",
  });
}
