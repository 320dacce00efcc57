// The nip itself to scale: layers and deformed surfaces as computed.

import { nipText } from "./quantities.js";
import { svg } from "./dom.js";
import { picture, words } from "./drawing.js";
import { toneOf } from "./palette.js";
import { sheetCaption, sheetInNip, sheetSize } from "./sheetdrawing.js";
import { say } from "./texts.js";

const STRIP = 30; // px below the picture for the dimension
const HALF = 0.95; // half the window, in nip widths

/** Half the width of the window around the nip [mm]. */
export function windowOf(result) {
  return HALF * result.nip_width;
}

/** The nip and its neighbourhood, to scale, from the surfaces the server computed. */
export function sectionPicture(tree, result, surfaces, { width, height, palette, units }) {
  const text = nipText("nip_width", result, units);
  const node = picture(width, height, say("section.label", { text }), palette);
  const frame = frameOf(result, surfaces, width, height - STRIP);
  const clip = `clip-${width}-${height}-${palette.name}`;
  node.append(svg("clipPath", { id: clip }, svg("rect", { width, height: height - STRIP })));
  const inside = svg("g", { "clip-path": `url(#${clip})` });
  const half = tree.sheet ? 0.5 * sheetSize(tree.sheet, frame.scale).pixels : 0;
  for (const side of ["lower", "upper"]) {
    const apart = { ...frame, y: (z) => frame.y(z) + (side === "upper" ? -half : half) };
    inside.append(...body(side, tree, result, surfaces, apart, palette));
  }
  if (tree.sheet) inside.append(sheetInNip(result, surfaces, frame, 2 * half, palette));
  node.append(inside, strip(result, text, frame, palette, { width, height }));
  return node;
}

/** What stands below the picture of a nip drawn `width` pixels wide. */
export function sectionCaption(tree, result, width) {
  const scale = width / (2 * HALF * result.nip_width);
  return say("drawing.nip") + (tree.sheet ? `; ${sheetCaption(sheetSize(tree.sheet, scale))}` : "");
}

/** Pixels of a place [mm]. */
function frameOf({ contact, nip_width: nip }, surfaces, width, height) {
  const middle = 0.5 * (contact[0][0] + contact[contact.length - 1][1]);
  const scale = width / (2 * HALF * nip);
  const heights = surfaces.lower.x
    .map((x, i) => [x, surfaces.lower.z[i]])
    .filter(([x]) => Math.abs(x - middle) < 0.5 * nip);
  const level = heights.reduce((sum, [, z]) => sum + z, 0) / Math.max(1, heights.length);
  const reach = HALF * nip;
  return {
    scale,
    reach: [middle - reach, middle + reach],
    x: (x) => width / 2 + (x - middle) * scale,
    y: (z) => height / 2 - (z - level) * scale,
    bottom: height,
  };
}

/** The layers and the core of one roller, from the surface inwards. */
function body(side, tree, result, surfaces, frame, palette) {
  const { layers, core } = tree[side];
  const curve = curvesOf(side, tree, result, surfaces, frame);
  const total = layers.reduce((sum, layer) => sum + layer.thickness, 0);
  const far = core ? total + result.nip_width : total; // where the deformation has died out, drawn
  const shapes = [];
  let depth = 0;
  const bands = [
    ...layers.map((layer, i) => [layer.thickness, toneOf(side, i, palette)]),
    [0, palette.core],
  ];
  for (const [thickness, fill] of bands) {
    const share = far > 0 ? Math.max(0, 1 - depth / far) : 1;
    shapes.push(
      svg("path", {
        d: closed(side, curve(depth, share), frame),
        fill,
        stroke: palette.coreEdge,
        "stroke-width": depth === 0 ? 1.4 : 0.7,
      }),
    );
    depth += thickness;
  }
  return shapes;
}

/** Points (x, height) of the place at some depth; the surface's displacement fades with `share`. */
function curvesOf(side, tree, result, surfaces, frame) {
  const up = side === "upper" ? 1 : -1;
  const { x, z } = surfaces[side];
  const radius = tree[side].radius === "inf" ? 1e9 : tree[side].radius;
  const base = axisOf(side, result, radius, surfaces);
  const round = (r, at) =>
    radius === 1e9 ? base - up * r : base - up * Math.sqrt(Math.max(0, r * r - at * at));
  return (depth, share) =>
    x
      .map((at, i) => [at, round(radius - depth, at) + (z[i] - round(radius, at)) * share])
      .filter(([at]) => at >= frame.reach[0] - 1e-9 && at <= frame.reach[1] + 1e-9);
}

/** Height of the axle; where no approach is defined, from the far end of the surface. */
function axisOf(side, result, radius, surfaces) {
  const up = side === "upper" ? 1 : -1;
  if (result.approach !== null) return side === "upper" ? radius - result.approach : -radius;
  const { x, z } = surfaces[side];
  return z[0] + up * (radius === 1e9 ? radius : Math.sqrt(Math.max(0, radius * radius - x[0] * x[0])));
}

function closed(side, points, frame) {
  const edge = side === "upper" ? -20 : frame.bottom + 20;
  const xs = points.map(([x]) => frame.x(x));
  const line = points.map(([, z], i) => `${xs[i].toFixed(2)} ${frame.y(z).toFixed(2)}`).join("L");
  return `M-20 ${edge}L-20 ${frame.y(points[0][1]).toFixed(2)}L${line}L${(xs[xs.length - 1] + 40).toFixed(1)} ${frame.y(points[points.length - 1][1]).toFixed(2)}L${(xs[xs.length - 1] + 40).toFixed(1)} ${edge}Z`;
}

/** The dimension of the nip below the picture, with outlet and inlet. */
function strip({ contact }, text, frame, palette, { width, height }) {
  const top = height - STRIP;
  const [left, right] = [frame.x(contact[0][0]), frame.x(contact[contact.length - 1][1])];
  const y = top + 10;
  const line = { stroke: palette.ink, "stroke-width": 1.2, fill: "none" };
  const edges = [left, right].map((x) =>
    svg("path", {
      d: `M${x} ${0.42 * top}V${y + 5}`,
      stroke: palette.ink,
      "stroke-width": 0.8,
      "stroke-dasharray": "2 3",
    }),
  );
  const arrow = `M${left + 6} ${y - 4}L${left} ${y}L${left + 6} ${y + 4}M${left} ${y}H${right}M${right - 6} ${y - 4}L${right} ${y}L${right - 6} ${y + 4}`;
  return svg(
    "g",
    {},
    svg("rect", { y: top, width, height: STRIP, fill: palette.ground }),
    ...edges,
    svg("path", { d: arrow, ...line }),
    words((left + right) / 2, y + 16, text, { fill: palette.ink, size: 12.5, weight: 600 }),
    words(2, y + 16, say("section.outlet"), { anchor: "start", fill: palette.muted }),
    words(width - 2, y + 16, say("section.inlet"), { anchor: "end", fill: palette.muted }),
  );
}
