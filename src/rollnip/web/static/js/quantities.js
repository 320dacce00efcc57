// The inputs and the answers by name: how each is called, measured and explained.

import { getAt } from "./paths.js";
import { number } from "./units.js";

const NO_FORCE = 1e-9; // of the line load: forces below it (torques: at an arm of 1 mm) are rounding
const NO_LOSS = 1e-6; // of line load times speed: losses below it are the mesh's, not the nip's
const TINY = 2e-5; // relative errors below it say nothing to anybody

const MATERIAL = {
  shore_a: {
    label: "Hardness (Shore A)",
    dimension: "ratio",
    low: 20,
    high: 95,
    hint: "From the data sheet or a durometer. Its stiffness is an estimate: easily half or twice.",
  },
  modulus: {
    label: "Modulus",
    dimension: "pressure",
    low: 0.05,
    high: 500,
    log: true,
    hint: "Young's modulus; of a viscoelastic rubber the slow (relaxed) one.",
  },
  shear_modulus: { label: "Shear modulus", dimension: "pressure", low: 0.02, high: 200, log: true },
  stiffening: {
    label: "Stiffening",
    dimension: "pressure",
    low: 0.05,
    high: 500,
    log: true,
    hint: "How much stiffer the rubber is when pressed very fast.",
  },
  relaxation_time: {
    label: "Relaxation time",
    dimension: "time",
    low: 1e-5,
    high: 10,
    log: true,
    hint: "How long the rubber takes to settle.",
  },
  order: {
    label: "Order",
    dimension: "ratio",
    low: 0.05,
    high: 1,
    hint: "1: one relaxation time; less: spread over many.",
  },
  loss_factor: { label: "Loss factor", dimension: "ratio", low: 0.01, high: 0.6 },
  poisson: {
    label: "Poisson's ratio",
    dimension: "ratio",
    low: 0,
    high: 0.5,
    hint: "0.5 for solid rubber; less for foam.",
  },
  temperature: { label: "Temperature", dimension: "temperature", low: -40, high: 150 },
  "shift.reference": { label: "Reference temperature", dimension: "temperature", low: -40, high: 150 },
  "shift.c1": { label: "Shift c1", dimension: "ratio", low: 1, high: 40 },
  "shift.c2": { label: "Shift c2", dimension: "temperature difference", low: 10, high: 300 },
  "shift.activation_energy": { label: "Activation energy", dimension: "molar energy", low: 10, high: 400 },
};

const NIP = {
  load: {
    label: "Line load",
    dimension: "line load",
    low: 0.05,
    high: 200,
    log: true,
    hint: "Force of both sides together over the width of the face.",
  },
  approach: {
    label: "Indentation",
    dimension: "length",
    low: 0.005,
    high: 8,
    log: true,
    hint: "How far the axles move together after first touch.",
  },
  friction: {
    label: "Friction coefficient",
    dimension: "ratio",
    low: 0,
    high: 2,
    hint: "Dry rubber 0.5 and more, wet or oily 0.1.",
  },
  speed: { label: "Speed", dimension: "speed", low: 5, high: 50000, log: true },
  traction: {
    label: "Traction",
    dimension: "line load",
    hint: "Force the upper roller drives the lower one with; negative: it is driven.",
  },
  creepage: {
    label: "Creepage",
    dimension: "share",
    low: -0.06,
    high: 0.06,
    hint: "Surface speed of the upper roller over the lower one's, set by gears or drives.",
  },
  torque_lower: {
    label: "Torque on the lower roller",
    dimension: "force",
    low: -200,
    high: 200,
    hint: "Per width; positive drives it, negative brakes it.",
  },
  face_width: {
    label: "Face width",
    dimension: "length",
    low: 10,
    high: 10000,
    log: true,
    hint: "Gives forces, torques and power of the whole roller.",
  },
};

const SIZES = {
  radius: { label: "Diameter", dimension: "length", low: 10, high: 1500, log: true, factor: 2 },
  thickness: { label: "Thickness", dimension: "length", low: 0.05, high: 50, log: true },
};

const TERMS = {
  modulus: { ...MATERIAL.modulus, label: "Stiffness that relaxes", hint: null },
  relaxation_time: { ...MATERIAL.relaxation_time, hint: null },
};

/** The input at a path: {path, label, dimension, low, high, log, hint, factor}; shown is factor times the value. */
export function inputAt(path, tree) {
  const last = path.replace(/^.*?(shift\.[a-z0-9_]+|[a-z_]+)$/, "$1");
  const start = { path, factor: 1 };
  if (path.startsWith("nip.")) return { ...start, ...NIP[last], ...tractionRange(last, tree) };
  if (path.includes(".terms[")) return { ...start, ...TERMS[last] };
  const hint = path === "upper.radius" ? "Over the covering, as on the drawing." : null;
  return { ...start, hint, ...(SIZES[last] ?? MATERIAL[last]) };
}

function tractionRange(name, tree) {
  if (name !== "traction") return {};
  const load = tree.nip.load ?? 5;
  const most = Number((0.98 * tree.nip.friction * load).toPrecision(3)) || 0.1;
  return { low: -most, high: most };
}

/** Every number of a design that can be varied, for what-if and the inverse: {path, label, ...}. */
export function inputsOf(tree) {
  const paths = Object.keys(NIP)
    .filter((name) => typeof tree.nip[name] === "number")
    .map((name) => `nip.${name}`);
  const found = paths.map((path) => inputAt(path, tree));
  for (const side of ["upper", "lower"]) {
    const name = side === "upper" ? "Upper" : "Lower";
    if (typeof tree[side].radius === "number")
      found.push(named(`${name} roller`, inputAt(`${side}.radius`, tree)));
    tree[side].layers.forEach((layer, i) => {
      const where = tree[side].layers.length > 1 ? `${name} layer ${i + 1}` : `${name} covering`;
      found.push(named(where, inputAt(`${side}.layers[${i}].thickness`, tree)));
      for (const key of Object.keys(MATERIAL)) {
        const path = `${side}.layers[${i}].material.${key}`;
        if (typeof getAt(tree, path) === "number") found.push(named(where, inputAt(path, tree)));
      }
    });
  }
  return found;
}

function named(where, input) {
  return {
    ...input,
    label: `${where}: ${input.label.charAt(0).toLowerCase()}${input.label.slice(1)}`
      .replace("shore", "Shore")
      .replace("poisson", "Poisson"),
  };
}

const positive = (value) =>
  value > 0 ? "the upper roller's surface runs faster" : "the lower roller's surface runs faster";

/** The answers: key in the result, name, dimension and a hint in plain words. */
export const ANSWERS = [
  {
    key: "nip_width",
    label: "Nip width",
    dimension: "length",
    hint: () => "Length of contact along the circumference: what an ink print of the nip at rest shows.",
  },
  {
    key: "approach",
    label: "Indentation",
    dimension: "length",
    hint: () => "How far the axles come together after first touch (the approach).",
  },
  {
    key: "load",
    label: "Line load",
    dimension: "line load",
    hint: () => "Pressing force per width of the face.",
  },
  {
    key: "peak_pressure",
    label: "Peak pressure",
    dimension: "pressure",
    hint: () => "The highest pressure in the nip: what the web feels at most.",
  },
  {
    key: "mean_pressure",
    label: "Mean pressure",
    dimension: "pressure",
    hint: () => "Line load over the nip width.",
  },
  {
    key: "dwell_time",
    label: "Dwell time",
    dimension: "time",
    hint: () => "How long a point of the web is pressed.",
  },
  {
    key: "speed_ratio",
    label: "Speed ratio",
    dimension: "ratio",
    digits: 5,
    hint: (r) =>
      `Surface speed of the upper over the lower roller, away from the nip${r.speed_ratio ? `: ${number(1000 * Math.abs(r.speed_ratio - 1))} m in 1000 m` : ""}.`,
  },
  {
    key: "creepage",
    label: "Creepage",
    dimension: "share",
    hint: (r) =>
      `Difference of the surface speeds over their mean${r.creepage ? `: ${positive(r.creepage)}` : ""}.`,
  },
  {
    key: "traction",
    label: "Traction",
    dimension: "line load",
    hint: () => "Force along the surface per width; positive: the upper roller drives.",
  },
  {
    key: "torque_upper",
    label: "Torque, upper roller",
    dimension: "force",
    hint: () => "On its axle, per width of the face; positive puts power in.",
  },
  {
    key: "torque_lower",
    label: "Torque, lower roller",
    dimension: "force",
    hint: () => "On its axle, per width of the face; positive puts power in.",
  },
  {
    key: "max_surface_strain",
    label: "Largest surface strain",
    dimension: "share",
    hint: () => "Most that either surface is stretched or squeezed along the nip.",
  },
  {
    key: "dissipation_friction",
    label: "Loss by slip",
    dimension: "power per length",
    hint: () => "Heat made where the surfaces slip, per width of the face.",
  },
  {
    key: "dissipation_viscous",
    label: "Loss in the rubber",
    dimension: "power per length",
    hint: () => "Heat made inside viscoelastic coverings, per width of the face.",
  },
  {
    key: "rolling_resistance",
    label: "Rolling resistance",
    dimension: "ratio",
    hint: () => "Loss in the rubber over line load times speed, as a coefficient.",
  },
];

const TOTALS = [
  { key: "load", label: "Pressing force, whole face", unit: "N" },
  { key: "traction", label: "Traction, whole face", unit: "N" },
  { key: "torque_upper", label: "Torque upper, whole face", unit: "N·m" },
  { key: "torque_lower", label: "Torque lower, whole face", unit: "N·m" },
  { key: "dissipation_friction", label: "Loss by slip, whole face", unit: "W" },
  { key: "dissipation_viscous", label: "Loss in the rubber, whole face", unit: "W" },
];
const US_TOTALS = { N: ["lbf", 4.4482216152605], "N·m": ["lbf·ft", 1.3558179483314], W: ["W", 1] };

/** The result with every scalar on its first level, as sweeps give it; what is rounding only is zero. */
export function flat(result) {
  const { load, nip_width: nip, dwell_time: dwell, dissipation } = result;
  const force = NO_FORCE * load;
  const power = dwell ? (NO_LOSS * load * nip) / dwell : 0;
  const forces = ["traction", "torque_upper", "torque_lower"].map((key) => [
    key,
    cleaned(result[key], force),
  ]);
  return {
    ...result,
    ...Object.fromEntries(forces),
    dissipation_friction: cleaned(dissipation.friction, power),
    dissipation_viscous: cleaned(dissipation.viscous, power),
    max_surface_strain: result.max_surface_strain ?? largestStrain(result),
  };
}

function cleaned(value, none) {
  return value !== null && Math.abs(value) < none ? 0 : value;
}

/** An estimated error worth showing, or null. */
export function errorOf(all, key) {
  const error = all.error?.[key];
  return error && error > TINY * Math.abs(all[key]) ? error : null;
}

function largestStrain({ profiles, contact }) {
  const [first, last] = [contact[0][0], contact[contact.length - 1][1]];
  const inside = profiles.x.map((x) => x >= first && x <= last);
  const strains = [...profiles.strain_upper, ...profiles.strain_lower];
  const sizes = strains.filter((value, i) => value !== null && inside[i % inside.length]).map(Math.abs);
  return sizes.length ? Math.max(...sizes) : null;
}

/** Totals over the face width as {label, text, unit}. */
export function totalsOf(result, system) {
  if (!result.totals) return [];
  return TOTALS.filter(({ key }) => result.totals[key] !== null).map(({ key, label, unit }) => {
    const [name, scale] = system === "us" ? US_TOTALS[unit] : [unit, 1];
    return { label, text: number(result.totals[key] / scale), unit: name };
  });
}
