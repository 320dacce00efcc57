// The inputs and the answers by name: how each is called, measured and explained.

import { FIGURES, ROUNDING, TOTALS } from "./figures.js";
import { getAt } from "./paths.js";
import { number } from "./units.js";

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

function labelOf(key) {
  return FIGURES.find((figure) => figure.key === key).label;
}

const NIP = {
  load: {
    label: labelOf("load"),
    dimension: "line load",
    low: 0.05,
    high: 200,
    log: true,
    hint: "Force of both sides together over the width of the face.",
  },
  approach: {
    label: labelOf("approach"),
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
    label: labelOf("traction"),
    dimension: "line load",
    hint: "Force the upper roller drives the lower one with; negative: it is driven.",
  },
  creepage: {
    label: labelOf("creepage"),
    dimension: "share",
    low: -0.06,
    high: 0.06,
    hint: "Surface speed of the upper roller over the lower one's, set by gears or drives.",
  },
  torque_lower: {
    label: labelOf("torque_lower"),
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

// What a figure means at the size it has.
const MEANINGS = {
  nip_width: () => " An ink print of the nip at rest shows it.",
  speed_ratio: (value) => (value ? ` Here ${number(1000 * Math.abs(value - 1))} m in 1000 m.` : ""),
  creepage: (value) => (value ? ` Here ${positive(value)}.` : ""),
};

/** The answers: key in the flat result, label, dimension, digits, and a hint in plain words. */
export const ANSWERS = FIGURES.map((figure) => ({
  ...figure,
  hint: ({ [figure.key]: value }) => figure.hint + (MEANINGS[figure.key]?.(value) ?? ""),
}));

/** The result with every scalar on its first level, as sweeps give it; what is rounding only is zero. */
export function flat(result) {
  const { friction, viscous } = result.dissipation;
  const all = { ...result, dissipation_friction: friction, dissipation_viscous: viscous };
  const cleaned = FIGURES.map(({ key, size }) => [key, isNoise(all, key, size) ? 0 : all[key]]);
  return { ...all, ...Object.fromEntries(cleaned) };
}

function isNoise(all, key, size) {
  const value = all[key];
  if (value === null || value === undefined) return false;
  const factors = Object.entries(size).map(([name, power]) => Math.abs(all[name] ?? 0) ** power);
  return Math.abs(value) < factors.reduce((product, factor) => product * factor, ROUNDING);
}

/** An estimated error worth showing, or null. */
export function errorOf(all, key) {
  const error = all.error?.[key];
  return error && error > TINY * Math.abs(all[key]) ? error : null;
}

/** Totals over the face width as {label, text, unit}. */
export function totalsOf(result, system) {
  if (!result.totals) return [];
  return TOTALS.filter(({ key }) => result.totals[key] !== null).map(({ key, label, units }) => {
    const [unit, scale] = units[system];
    return { label, text: number(result.totals[key] / scale), unit };
  });
}
