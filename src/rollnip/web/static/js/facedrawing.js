// Drawings along the face: the bent rollers, and the print that carbon paper keeps of the nip.

import { figureIn } from "./quantities.js";
import { picture, words } from "./drawing.js";
import { svg } from "./dom.js";
import { SIDES, coreDiameter } from "./face.js";
import { toneOf } from "./palette.js";
import { say } from "./texts.js";
import { nice, number } from "./units.js";

const MARGIN = 34; // px to either side, for the bearings
const BEND = 17; // px, of the largest deflection or crown as drawn
const TALLEST = 250; // px of both rollers
const PRINT = 54; // px, of the widest place of the stretched print

/** Both rollers from the side, bent under the load: {node, times}, deflections drawn `times` larger. */
export function bentPicture(tree, face, { width, palette, units }) {
  const frame = frameOf(tree, face, width);
  const label = say("face.label", { times: number(frame.times), load: units.figure(figureIn("face", "mean_load"), face.mean_load) });
  const node = picture(width, frame.height, label, palette);
  for (const side of SIDES) node.append(...rollerParts(side, tree, face, frame, palette));
  for (const side of SIDES) node.append(...bearings(side, tree, face, frame, { palette, units }));
  return { node, times: frame.times };
}

function frameOf(tree, face, width) {
  const { y } = face;
  const half = Math.max(-y[0], ...SIDES.map((side) => reachOf(tree[side].shaft)));
  const radii = SIDES.map((side) => sizeOf(tree, side));
  const scale = Math.min((width - 2 * MARGIN) / (2 * half), TALLEST / (2 * (radii[0] + radii[1])));
  const shapes = SIDES.flatMap((side) => [face[`deflection_${side}`], face.crown[side]]);
  const most = Math.max(...shapes.flat().map(Math.abs));
  const times = most > 0 ? Math.max(1, nice(BEND / (scale * most))) : 1;
  // Surfaces before the rubber is squeezed, where they first touch.
  const near = y.map((_y, i) => facing(face, i));
  const touch = Math.max(...near);
  const nip = 2 * BEND + 2 * scale * radii[0];
  return {
    scale,
    times,
    touch,
    nip,
    height: nip + 2 * scale * radii[1] + 2 * BEND,
    x: (at) => width / 2 + at * scale,
    bent: (value) => value * times * scale,
  };
}

/** How far from the middle of the face the farther bearing of a shaft stands [mm]. */
function reachOf(shaft) {
  return shaft ? 0.5 * shaft.bearing_distance + Math.abs(shaft.bearing_middle ?? 0) : 0;
}

/** How far both surfaces have come towards each other at a place, without a common approach [mm]. */
function facing(face, i) {
  const { crown, deflection_upper: up, deflection_lower: down } = face;
  return crown.upper[i] + crown.lower[i] - up[i] - down[i];
}

function sizeOf(tree, side) {
  const { radius } = tree[side];
  return radius === "inf" ? 0.35 * tree[side === "upper" ? "lower" : "upper"].radius : radius;
}

/** Height [px] of the axis of a roller at a place: deflected away from the other one. */
function axisOf(side, tree, face, frame) {
  const up = side === "upper" ? -1 : 1;
  const lift = side === "upper" ? frame.bent(frame.touch) : 0;
  const middle = frame.nip - lift + up * sizeOf(tree, side) * frame.scale;
  return (i) => middle + up * frame.bent(face[`deflection_${side}`][i]);
}

function rollerParts(side, tree, face, frame, palette) {
  const { layers } = tree[side];
  const axis = axisOf(side, tree, face, frame);
  const size = sizeOf(tree, side) * frame.scale;
  let depth = 0;
  const bands = [...layers.map(({ thickness }, i) => [thickness, toneOf(side, i, palette)]), [0, palette.core]];
  return bands.map(([thickness, fill]) => {
    const reach = (i) => Math.max(1, size + frame.bent(face.crown[side][i]) - depth * frame.scale);
    const above = face.y.map((y, i) => `${frame.x(y).toFixed(2)} ${(axis(i) - reach(i)).toFixed(2)}`);
    const below = face.y.map((y, i) => `${frame.x(y).toFixed(2)} ${(axis(i) + reach(i)).toFixed(2)}`);
    depth += thickness;
    const d = `M${above.join("L")}L${below.reverse().join("L")}Z`;
    return svg("path", { d, fill, stroke: palette.coreEdge, "stroke-width": 0.8 });
  });
}

/** Journals to the bearings, the bearings, and the forces on them. */
function bearings(side, tree, face, frame, { palette, units }) {
  const { shaft } = tree[side];
  if (!shaft) return [];
  const axis = axisOf(side, tree, face, frame);
  const up = side === "upper" ? -1 : 1;
  const rest = axis(0) - up * frame.bent(face[`deflection_${side}`][0]);
  const core = coreDiameter(tree[side]) ?? 0;
  const half = Math.max(2, 0.5 * (shaft.journal_diameter ?? shaft.journals?.at(-1)?.diameter ?? 0.5 * core) * frame.scale);
  return [0, 1].flatMap((end) => {
    const [sign, at] = end === 0 ? [-1, 0] : [1, face.y.length - 1];
    const [inner, outer] = [frame.x(face.y[at]), frame.x((shaft.bearing_middle ?? 0) + 0.5 * sign * shaft.bearing_distance)];
    const force = face.bearing_forces[side][end];
    const points = [
      [inner, axis(at) - half],
      [outer, rest - half],
      [outer, rest + half],
      [inner, axis(at) + half],
    ];
    const d = `M${points.map((one) => one.map((place) => place.toFixed(2)).join(" ")).join("L")}Z`;
    const foot = rest + up * (half + 9);
    const stand = `M${outer} ${rest + up * half}L${outer - 6} ${foot}H${outer + 6}Z`;
    const anchor = sign < 0 ? "start" : "end";
    const edge = outer + sign * 8;
    return [
      svg("path", { d, fill: palette.core, stroke: palette.coreEdge, "stroke-width": 0.8 }),
      svg("path", { d: stand, fill: palette.bound }),
      words(Math.max(2, edge), foot + (up < 0 ? -4 : 12), units.text(force, "roller force", 3), {
        anchor,
        fill: palette.ink,
        size: 11.5,
      }),
    ];
  });
}

/** The nip width over the face: as wide as it is, and stretched: {node, times}. */
export function printPicture(face, { width, palette, units }) {
  const { y, nip_width: nip } = face;
  const length = y[y.length - 1] - y[0];
  const scale = (width - 2 * MARGIN) / length;
  const most = Math.max(...nip);
  const times = Math.max(1, nice(PRINT / (most * scale)));
  const x = (at) => width / 2 + at * scale;
  const thin = Math.max(10, most * scale + 6);
  const height = times * most * scale + thin + 34;
  const ends = [0, Math.floor(y.length / 2), y.length - 1].map((i) => units.text(nip[i], "length", 3));
  const label = say("face.print-label", { first: ends[0], middle: ends[1], last: ends[2] });
  const node = picture(width, height, label, palette);
  const shape = (middle, factor) => {
    const edge = (sign) => y.map((at, i) => `${x(at).toFixed(2)} ${(middle + sign * 0.5 * factor * scale * nip[i]).toFixed(2)}`);
    const d = `M${edge(-1).join("L")}L${edge(1).reverse().join("L")}Z`;
    return svg("path", { d, fill: palette.ink, "fill-opacity": 0.82 });
  };
  const middle = 8 + 0.5 * times * most * scale;
  node.append(shape(middle, times));
  const floor = height - 0.5 * thin - 3;
  node.append(shape(floor, 1));
  const places = [x(y[0]), x(0), x(y[y.length - 1])];
  const anchors = ["start", "middle", "end"];
  ends.forEach((text, i) =>
    node.append(
      words(places[i], height - thin - 8, text, { anchor: anchors[i], fill: palette.ink, size: 12.5, weight: 600 }),
    ),
  );
  return { node, times };
}
