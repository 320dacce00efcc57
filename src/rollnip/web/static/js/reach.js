// How far sliders reach whose ends depend on the rest of the design.

import { meanLoad } from "./face.js";

const CROWN = 0.01; // largest crown of a slider, as a share of the radius
const THINNEST = 0.98; // largest bore of a slider, as a share of the core

/** The traction is less than friction times load. */
export function tractionRange(name, tree) {
  if (name !== "traction") return {};
  const load = tree.nip.load ?? meanLoad(tree) ?? 5;
  const most = Number((0.98 * tree.nip.friction * load).toPrecision(3)) || 0.1;
  return { low: -most, high: most };
}

/** Large rollers take large crowns; a bore ends where the core does. */
export function shaftRange(name, usual, { radius, layers = [] }) {
  if (typeof radius !== "number") return {};
  if (name === "crown.height") {
    const high = Math.max(usual.high, Number((CROWN * radius).toPrecision(2)));
    return { low: -high / 3, high };
  }
  const core = radius - layers.reduce((sum, { thickness }) => sum + thickness, 0);
  return name === "bore" && core > 0 ? { high: Number((2 * THINNEST * core).toPrecision(3)) } : {};
}
