// A patch in three dimensions: what a design holds of it, and the case it makes. Pure functions.

import { getAt, setAt } from "./paths.js";

export const SIDES = ["upper", "lower"];
/** Rectangles along each side while a slider moves. */
export const COARSE = [24, 24];
export const ACCURACIES = [0.02, 0.01, 0.005];
const NUMBERS = {
  nip: ["load", "approach", "traction", "creepage", "lateral_traction", "lateral_creepage", "spin"],
  upper: ["lateral_radius", "face", "end_radius"],
  lower: ["lateral_radius", "face", "end_radius"],
};
const CROWN = { metric: 400, us: 406.4 }; // mm, 16 in
const FACE = { metric: 80, us: 76.2 };
const LOAD = { metric: 500, us: 444.82216152605 }; // N, 100 lbf

/** The patch to begin with: a crowned upper roller, pressed, rolling freely. */
export function patchStart(system) {
  const nip = { load: LOAD[system], traction: 0, lateral_creepage: 0, spin: 0 };
  return { nip, upper: { lateral_radius: CROWN[system] }, lower: {}, tolerance: 0.01 };
}

/** The patch in a state from outside: its numbers, whatever else it holds; null where there is none. */
export function patchOf(given, system) {
  if (!given || typeof given !== "object") return null;
  const parts = Object.entries(NUMBERS).map(([part, names]) => [
    part,
    Object.fromEntries(names.map((name) => [name, given[part]?.[name]]).filter(([, value]) => Number.isFinite(value))),
  ]);
  const patch = { ...Object.fromEntries(parts), tolerance: Number(given.tolerance) || 0.01 };
  const isPressed = patch.nip.load !== undefined || patch.nip.approach !== undefined;
  return isPressed ? patch : patchStart(system);
}

/** The case of a patch: rollers, friction and speed of the design; `grid` as given, else as fine as wanted. */
export function patchCase(tree, patch, grid = null) {
  const roller = (side) => {
    const { radius, layers, core } = tree[side];
    return { radius, layers, ...(core ? { core } : {}), ...patch[side] };
  };
  const { friction, speed } = tree.nip;
  return {
    title: tree.title,
    nip: { ...patch.nip, friction, ...(speed === undefined ? {} : { speed }) },
    patch: grid ? { grid } : {},
    solver: { tolerance: patch.tolerance },
    upper: roller("upper"),
    lower: roller("lower"),
  };
}

/** "load" or "approach". */
export function patchPress(patch) {
  return patch.nip.approach === undefined ? "load" : "approach";
}

/** "traction" or "creepage" along x, or with "lateral_" before it along y. */
export function patchDrive(patch, across) {
  const before = across ? "lateral_" : "";
  return patch.nip[`${before}creepage`] === undefined ? "traction" : "creepage";
}

/** Another kind of pressing or driving: the key that goes, the one that comes, and its value. */
export function exchanged(patch, gone, come, value) {
  return setAt(setAt(patch, `nip.${gone}`, undefined), `nip.${come}`, Number(value.toPrecision(4)));
}

/** "straight", "crowned" or "hollow". */
export function shapeAcross(patch, side) {
  const radius = patch[side].lateral_radius;
  if (radius === undefined) return "straight";
  return radius > 0 ? "crowned" : "hollow";
}

/** A roller of another shape across; what it was before does not count any more. */
export function withShape(patch, side, shape, system) {
  const size = Math.abs(getAt(patch, `${side}.lateral_radius`) ?? CROWN[system]);
  const radius = { straight: undefined, crowned: size, hollow: -size }[shape];
  return setAt(patch, `${side}.lateral_radius`, radius);
}

/** A roller whose face ends, or does not. */
export function withEnds(patch, side, yes, system) {
  const { face: _face, end_radius: _end, ...rest } = patch[side];
  return { ...patch, [side]: yes ? { ...rest, face: FACE[system], end_radius: 0 } : rest };
}
