// What a design is: the tree of a case file with plain numbers (mm, N, MPa, s). Pure functions.

import { byMeanLoad, shaftOf } from "./face.js";
import { coolingOf, warmedAs } from "./heat.js";
import { getAt, setAt, steps } from "./paths.js";
import { sheetOf } from "./sheet.js";
import { say } from "./texts.js";

export const RIGID = "rigid";
export const PLANE = "inf";
export const RUBBER = { model: "elastic", shore_a: 60, poisson: 0.5 };

const STARTS = {
  metric: { load: 4, speed: 1000, upper: 100, thickness: 12, lower: 75 },
  us: { load: 3.5025366, speed: 1016, upper: 101.6, thickness: 12.7, lower: 76.2 }, // 20 pli, 200 fpm, 8 in
};

/** The nip on the first screen: a press roller of 60 Shore A on a steel roller, in round numbers. */
export function defaultCase(system = "metric") {
  const { load, speed, upper, thickness, lower } = STARTS[system];
  return {
    title: "",
    nip: { load, friction: 0.5, speed },
    model: { geometry: "finite" },
    upper: { radius: upper, layers: [{ thickness, material: { ...RUBBER } }] },
    lower: { radius: lower, layers: [] },
  };
}

/**
 * The design with another size at a path. Where a roller keeps its core ("core" in `keeps`), its
 * diameter follows the thickness of a layer, and its first layer the diameter: wear and regrind.
 */
export function withSize(tree, path, value, keeps = {}) {
  const [side, key, i, last] = steps(path);
  const changed = withLength(setAt(tree, path, value), path, value);
  const { radius, layers } = tree[side] ?? {};
  if (keeps[side] !== "core" || typeof radius !== "number" || layers.length === 0) return changed;
  if (key === "radius")
    return setAt(changed, `${side}.layers[0].thickness`, tidy(layers[0].thickness + value - radius));
  if (key !== "layers" || last !== "thickness") return changed;
  return setAt(changed, `${side}.radius`, tidy(radius + value - layers[i].thickness));
}

/** Face width and length of the face are one size. */
function withLength(tree, path, value) {
  if (path === "face.length" && tree.nip.face_width !== undefined)
    return setAt(tree, "nip.face_width", value);
  return path === "nip.face_width" && tree.face ? setAt(tree, "face.length", value) : tree;
}

/** Without the last digits, which sums of decimals leave. */
function tidy(value) {
  return Number(value.toPrecision(12));
}

/** The coverings of both rollers in each other's place. */
export function swapped(tree) {
  const put = (to, from) => {
    const { core: _core, ...rest } = tree[to];
    const { core, layers } = tree[from];
    return { ...rest, ...(core ? { core } : {}), layers };
  };
  return { ...tree, upper: put("upper", "lower"), lower: put("lower", "upper") };
}

/** A case as the server normalised it, with the materials where they are used. */
export function designOf(tree) {
  const named = tree.materials ?? {};
  const material = (value) => (typeof value === "string" && value !== RIGID ? named[value] : value);
  const roller = (side) => {
    const layers = (side.layers ?? []).map((layer) => ({ ...layer, material: material(layer.material) }));
    const core = side.core === undefined || side.core === RIGID ? {} : { core: material(side.core) };
    const shaft = side.shaft ? { shaft: shaftOf(side.shaft) } : {};
    const heat = side.heat ? { heat: coolingOf(side.heat) } : {};
    return { ...side, core: undefined, ...core, layers, ...shaft, ...heat };
  };
  const { materials: _named, ...rest } = tree;
  const sheet = tree.sheet ? { sheet: sheetOf(tree.sheet) } : {};
  const whole = {
    model: { geometry: "finite" },
    title: "",
    ...rest,
    ...sheet,
    upper: roller(tree.upper),
    lower: roller(tree.lower),
  };
  if (!whole.model.geometry || whole.model.geometry === "full") whole.model = { ...whole.model, geometry: "finite" };
  return bare(whole);
}

function bare(tree) {
  if (Array.isArray(tree)) return tree.map(bare);
  if (!tree || typeof tree !== "object") return tree;
  const kept = Object.entries(tree).filter(([, value]) => value !== null && value !== undefined);
  return Object.fromEntries(kept.map(([name, value]) => [name, bare(value)]));
}

/** The same nip while a slider moves: curved layers, which are faster, in place of finite strain. */
export function quickCase(tree) {
  return ["second", "finite"].includes(tree.model.geometry) ? setAt(tree, "model.geometry", "curved") : tree;
}

/** "load" or "approach". */
export function pressing(tree) {
  return tree.nip.approach === undefined ? "load" : "approach";
}

/** "free", "traction", "creepage" or "idler". */
export function driving(tree) {
  const { traction, creepage, torque_lower: torque } = tree.nip;
  if (creepage !== undefined) return "creepage";
  if (torque !== undefined) return torque === 0 ? "idler" : "torque";
  return traction === undefined || traction === 0 ? "free" : "traction";
}

/** Change the kind of pressing; the new value is what the nip has now, so nothing jumps. */
export function pressBy(tree, kind, result) {
  const { load: _load, approach: _approach, ...nip } = tree.nip;
  const value = result?.[kind] ?? (kind === "load" ? 4 : 0.4);
  return { ...byMeanLoad(tree), nip: { ...nip, [kind]: rounded(value) } };
}

/** Change the kind of driving; traction and creepage start from what the nip has now. */
export function driveBy(tree, kind, result) {
  const { traction: _t, creepage: _c, torque_lower: _q, ...nip } = tree.nip;
  const load = result?.load ?? nip.load ?? 4;
  const start = {
    free: {},
    traction: { traction: rounded(0.2 * nip.friction * load) },
    creepage: { creepage: rounded(result?.creepage ?? 0) },
    idler: { torque_lower: 0 },
    torque: { torque_lower: tree.nip.torque_lower ?? 0 },
  };
  return { ...tree, nip: { ...nip, ...start[kind] } };
}

function rounded(value) {
  return Number(value.toPrecision(4));
}

/** A material of another model that starts from what is known of the present one. */
export function materialAs(model, old) {
  const modulus = old.modulus ?? 3;
  const poisson = old.poisson ?? 0.5;
  const made = {
    shore: { model: "elastic", shore_a: 60, poisson },
    elastic: { model: "elastic", modulus, poisson },
    "standard-linear-solid": {
      model: "standard-linear-solid",
      modulus,
      stiffening: modulus,
      relaxation_time: 0.005,
      poisson,
    },
    prony: { model: "prony", modulus, terms: [term(modulus / 2, 0.001), term(modulus / 2, 0.01)], poisson },
    "fractional-zener": {
      model: "fractional-zener",
      modulus,
      stiffening: 5 * modulus,
      relaxation_time: 0.001,
      order: 0.4,
      poisson,
    },
    "loss-factor": { model: "loss-factor", modulus, loss_factor: 0.1, poisson },
  };
  const curved = old.energy ? { ...made[model], energy: old.energy } : made[model];
  return warmedAs(curved, old);
}

function term(modulus, time) {
  return { modulus, relaxation_time: time };
}

/** Which editor a material needs: its model, or "shore" where hardness is what is given. */
export function kindOf(material) {
  return material.shore_a !== undefined && material.model === "elastic" ? "shore" : material.model;
}

/** Layers changed by `act(list)`, on a roller "upper" or "lower". */
export function withLayers(tree, side, act) {
  const layers = [...(getAt(tree, `${side}.layers`) ?? [])];
  act(layers);
  return setAt(tree, `${side}.layers`, layers);
}

/** A name for a design nobody named. */
export function nameOf(tree) {
  return tree.title || say("design.untitled");
}

/** A viscoelastic material needs a speed; so does a loss. */
export function isViscoelastic(tree) {
  const materials = ["upper", "lower"].flatMap((side) => [
    tree[side].core,
    ...tree[side].layers.map((layer) => layer.material),
  ]);
  return materials.some((material) => material && material !== RIGID && material.model !== "elastic");
}
