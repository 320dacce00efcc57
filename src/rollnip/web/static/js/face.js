// The nip along its rollers: what a design holds of it. Pure functions.

import { withoutHeat } from "./heat.js";
import { getAt, same, setAt } from "./paths.js";

export const SIDES = ["upper", "lower"];
export const STEEL = { modulus: 206000, poisson: 0.3 };
export const STEEL_DENSITY = 7850; // kg/m3
const ROUND = { metric: 10, us: 12.7 }; // mm: sizes to begin with are multiples of it
const LENGTHS = { metric: 1000, us: 1016 };
const OVERHANG = 1.2; // bearing distance over face length, to begin with
const ARM = { bearing: 300, force: 600 }; // mm from the pivot, to begin with
const JOURNAL = 0.45; // journal over core, to begin with

/** The design with a face, and shafts in all rollers. */
export function withFace(tree, system) {
  const length = tree.nip.face_width ?? LENGTHS[system];
  const whole = { ...tree, face: { length, skew: 0, nip_angle: 0 } };
  return SIDES.reduce((one, side) => withShaft(one, side, system), whole);
}

/** The design with a shaft in a roller; a plane has none. */
export function withShaft(tree, side, system) {
  const core = coreDiameter(tree[side]);
  if (core === null || tree[side].shaft) return tree;
  const step = ROUND[system];
  const shaft = {
    bearing_distance: step * Math.ceil((OVERHANG * tree.face.length) / step),
    bearing_middle: 0,
    bore: 0,
    journal_diameter: journalFor(tree[side], system),
    ...STEEL,
    crown: { height: 0, shape: "parabolic" },
  };
  return setAt(tree, `${side}.shaft`, shaft);
}

/** A diameter of journals to begin with [mm]. */
export function journalFor(roller, system) {
  const step = ROUND[system];
  return step * Math.max(1, Math.round((JOURNAL * coreDiameter(roller)) / step));
}

/** The design without its face; the mean load stays. */
export function withoutFace(tree) {
  const { face: _face, ...rest } = byMeanLoad(tree);
  return SIDES.reduce((one, side) => setAt(one, `${side}.shaft`, undefined), rest);
}

/** The design under a mean line load instead of forces at its ends. */
export function byMeanLoad(tree) {
  const load = meanLoad(tree);
  if (load === null) return tree;
  const { end_loads: _ends, arms: _arms, ...face } = tree.face;
  return setAt({ ...tree, face }, "nip.load", load);
}

/** The design under forces at both ends that make a mean line load [N/mm]. */
export function byEndLoads(tree, load) {
  const { load: _load, approach: _approach, ...nip } = tree.nip;
  const half = Number((0.5 * load * tree.face.length).toPrecision(4));
  const { arms: _arms, ...face } = withoutOffset(tree.face);
  return { ...tree, nip, face: { ...face, end_loads: [half, half] } };
}

/** The design under a pivot arm at each end, which together make a mean line load [N/mm]. */
export function byArms(tree, load) {
  const { end_loads: _ends, ...face } = withoutOffset(tree.face);
  const { load: _load, approach: _approach, ...nip } = tree.nip;
  const force = Number((0.5 * load * tree.face.length * (ARM.bearing / ARM.force)).toPrecision(4));
  const arm = { bearing_lever: ARM.bearing, forces: [{ force, lever: ARM.force }] };
  return { ...tree, nip, face: { ...face, arms: [arm, structuredClone(arm)] } };
}

function withoutOffset({ bearing_offset: _offset, ...face }) {
  return face;
}

/** Forces at both ends [N], as given or by the moments of the arms about their pivots; null without. */
export function endLoads({ face }) {
  if (!face?.arms) return face?.end_loads ?? null;
  const ends = face.arms.map(({ bearing_lever: own, forces }) =>
    forces.reduce((sum, { force, lever }) => sum + (force * lever) / own, 0),
  );
  return [ends[0], ends[ends.length - 1]];
}

/** Line load that forces at the ends make in the mean [N/mm]; null where they are not given. */
export function meanLoad(tree) {
  const ends = endLoads(tree);
  return ends ? (ends[0] + ends[1]) / tree.face.length : null;
}

/** Diameter of the core under the coverings [mm]; null of a plane. */
export function coreDiameter({ radius, layers }) {
  if (typeof radius !== "number") return null;
  return 2 * layers.reduce((rest, { thickness }) => rest - thickness, radius);
}

/** Whether two designs have the same cold cross-section under the same load, whatever bends. */
export function sameNip(one, two) {
  return same(sectionOf(one), sectionOf(two));
}

function sectionOf(tree) {
  const { face: _face, title: _title, ...rest } = withoutHeat(tree);
  const bare = SIDES.reduce((one, side) => setAt(one, `${side}.shaft`, undefined), rest);
  return { ...bare, mean: meanLoad(tree) };
}

/** Shaft and face of a case as the page holds them: every number that has a control. */
export function shaftOf(shaft) {
  const { crown = 0 } = shaft;
  const whole = typeof crown === "number" ? { height: crown, shape: "parabolic" } : crown;
  const crowned = whole.shape || whole.height === undefined ? whole : { ...whole, shape: "parabolic" };
  return { bore: 0, bearing_middle: 0, ...STEEL, ...shaft, ...(shaft.modulus ? {} : { modulus: STEEL.modulus }), crown: crowned };
}

/** Paths of all numbers of the face of a design that have a control. */
export function facePaths(tree) {
  if (!tree.face) return [];
  const ends = (tree.face.end_loads ?? []).map((_one, i) => `face.end_loads[${i}]`);
  const arms = (tree.face.arms ?? []).flatMap(({ forces }, i) => [
    `face.arms[${i}].bearing_lever`,
    ...forces.flatMap((_one, j) => [`face.arms[${i}].forces[${j}].force`, `face.arms[${i}].forces[${j}].lever`]),
  ]);
  const names = ["bearing_distance", "bearing_middle", "bore", "journal_diameter", "modulus", "density", "crown.height"];
  const shafts = SIDES.flatMap((side) => names.map((name) => `${side}.shaft.${name}`));
  const weighs = SIDES.some((side) => tree[side].shaft?.density !== undefined);
  const all = ["face.length", "face.skew", "face.bearing_offset", "face.end_radius", ...(weighs ? ["face.nip_angle"] : []), ...ends, ...arms, ...shafts];
  return all.filter((path) => typeof getAt(tree, path) === "number");
}
