// The inputs and the answers by name: how each is called, measured and explained.

import { FIGURES, LOST, MORE_FIGURES, ROUNDING, SHEET_FIGURES, TOTALS } from "./figures.js";
import { getAt } from "./paths.js";
import { shaftRange, tractionRange } from "./reach.js";
import { sheetPaths } from "./sheet.js";
import { number, written } from "./units.js";
import { firstInText, say, sayOr } from "./texts.js";

const TINY = 2e-5; // relative errors below it say nothing to anybody

const MATERIAL = {
  shore_a: {
    label: say("input.shore"),
    dimension: "ratio",
    low: 20,
    high: 95,
    hint: say("hint.shore"),
  },
  modulus: {
    label: say("input.modulus"),
    dimension: "pressure",
    low: 0.01,
    high: 500,
    log: true,
    hint: say("hint.modulus"),
  },
  shear_modulus: { label: say("input.shear-modulus"), dimension: "pressure", low: 0.02, high: 200, log: true },
  stiffening: {
    label: say("input.stiffening"),
    dimension: "pressure",
    low: 0.05,
    high: 500,
    log: true,
    hint: say("hint.stiffening"),
  },
  relaxation_time: {
    label: say("input.relaxation"),
    dimension: "time",
    low: 1e-5,
    high: 10,
    log: true,
    hint: say("hint.relaxation"),
  },
  order: {
    label: say("input.order"),
    dimension: "ratio",
    low: 0.05,
    high: 1,
    hint: say("hint.order"),
  },
  loss_factor: { label: say("input.loss-factor"), dimension: "ratio", low: 0.01, high: 0.6 },
  poisson: {
    label: say("input.poisson"),
    dimension: "ratio",
    low: 0,
    high: 0.5,
    hint: say("hint.poisson"),
  },
  reading_time: { label: say("input.reading"), dimension: "time", low: 0.1, high: 60, log: true, hint: say("hint.reading") },
  temperature: { label: say("input.temperature"), dimension: "temperature", low: -40, high: 150 },
  "shift.reference": { label: say("input.reference"), dimension: "temperature", low: -40, high: 150 },
  "shift.c1": { label: say("input.c1"), dimension: "ratio", low: 1, high: 40 },
  "shift.c2": { label: say("input.c2"), dimension: "temperature difference", low: 10, high: 300 },
  "energy.second": { label: say("energy.second"), dimension: "ratio", low: -0.2, high: 0.2, hint: say("hint.second") },
  "energy.third": { label: say("energy.third"), dimension: "ratio", low: -0.02, high: 0.02 },
  "energy.limit": { label: say("energy.limit"), dimension: "ratio", low: 0.5, high: 200, log: true, hint: say("hint.limit") },
  "shift.activation_energy": { label: say("input.energy"), dimension: "molar energy", low: 10, high: 400 },
};

/** A figure of the registry in the language of the page. */
function said(figure) {
  const hint = sayOr(`figure.${figure.key}.hint`, figure.hint);
  return { ...figure, label: sayOr(`figure.${figure.key}`, figure.label), hint };
}

/** A figure or curve in the language of the page; `kind`: a registry of `MORE_FIGURES`. */
export function figureIn(kind, key) {
  return said({ ...MORE_FIGURES[kind][key], key: `${kind}_${key}` });
}

/** The name of a curve or field in a legend. */
export function curveName(kind, key) {
  return firstInText(figureIn(kind, key).label);
}

/** A figure of the nip in the language of the page. */
export function figureOfNip(wanted) {
  return said(FIGURES.find(({ key }) => key === wanted));
}

/** A figure of a result of the nip as a text with its unit. */
export function nipText(key, result, units) {
  return units.figure(figureOfNip(key), result[key]);
}

function totalLabel(key, label) {
  const figure = sayOr(`figure.${key}`, null);
  return figure === null ? label : say("figure.whole", { figure });
}

function labelOf(key) {
  return figureOfNip(key).label;
}

const NIP = {
  load: {
    label: labelOf("load"),
    dimension: "line load",
    low: 0.05,
    high: 500,
    log: true,
    hint: say("hint.load"),
  },
  approach: {
    label: labelOf("approach"),
    dimension: "length",
    low: 0.005,
    high: 8,
    log: true,
    hint: say("hint.approach"),
  },
  friction: {
    label: say("input.friction"),
    dimension: "ratio",
    low: 0,
    high: 2,
    hint: say("hint.friction"),
  },
  speed: { label: say("input.speed"), dimension: "speed", low: 5, high: 50000, log: true },
  traction: {
    label: labelOf("traction"),
    dimension: "line load",
    hint: say("hint.traction"),
  },
  creepage: {
    label: labelOf("creepage"),
    dimension: "share",
    low: -0.06,
    high: 0.06,
    hint: say("hint.creepage"),
  },
  torque_lower: {
    label: labelOf("torque_lower"),
    dimension: "force",
    low: -200,
    high: 200,
    hint: say("hint.torque"),
  },
  face_width: {
    label: say("input.face"),
    dimension: "length",
    low: 10,
    high: 10000,
    log: true,
    hint: say("hint.face"),
  },
};

const SIZES = {
  radius: { label: say("input.diameter"), dimension: "length", low: 10, high: 1500, log: true, factor: 2 },
  thickness: { label: say("input.thickness"), dimension: "length", low: 0.05, high: 50, log: true },
};

const TERMS = {
  modulus: { ...MATERIAL.modulus, label: say("input.term"), hint: null },
  relaxation_time: { ...MATERIAL.relaxation_time, hint: null },
  weight: { label: say("energy.weight"), dimension: "ratio", low: -5, high: 5, hint: say("hint.weight") },
  exponent: { label: say("energy.exponent"), dimension: "ratio", low: -10, high: 10 },
};

const END = { dimension: "roller force", low: 10, high: 500000, log: true, hint: say("hint.ends") };
const FACE = {
  length: { label: say("face.length"), dimension: "length", low: 50, high: 12000, log: true },
  skew: { label: say("face.skew"), dimension: "angle of axes", low: 0, high: 0.02, hint: say("hint.skew") },
  nip_angle: { label: say("face.angle"), dimension: "angle of axes", low: 0, high: Math.PI, hint: say("hint.angle") },
  bearing_offset: { label: say("face.offset"), dimension: "length", low: -0.5, high: 0.5, hint: say("hint.offset") },
  end_radius: { label: say("face.end-radius"), dimension: "length", low: 0, high: 50, hint: say("hint.end-radius") },
  bearing_lever: { label: say("face.bearing-lever"), dimension: "length", low: 20, high: 3000, log: true },
  force: { label: say("face.arm-force"), dimension: "roller force", low: 1, high: 100000, log: true, hint: say("hint.arm-force") },
  lever: { label: say("face.lever"), dimension: "length", low: 1, high: 5000, log: true },
  "end_loads[0]": { ...END, label: say("face.end-first") },
  "end_loads[1]": { ...END, label: say("face.end-second"), hint: null },
};
const SHAFT = {
  bearing_distance: {
    label: say("face.bearings"),
    dimension: "length",
    low: 60,
    high: 15000,
    log: true,
    hint: say("hint.bearings"),
  },
  bearing_middle: { label: say("face.bearing-middle"), dimension: "length", low: -200, high: 200, hint: say("hint.bearing-middle") },
  bore: { label: say("face.bore"), dimension: "length", low: 0, high: 1000, hint: say("hint.bore") },
  journal_diameter: { label: say("face.journal"), dimension: "length", low: 5, high: 1000, log: true },
  modulus: { label: say("face.modulus"), dimension: "pressure", low: 10000, high: 400000, log: true },
  density: { label: say("face.density"), dimension: "density", low: 1000, high: 12000 },
  "crown.height": {
    label: say("face.crown"),
    dimension: "length",
    low: -0.5,
    high: 1.5,
    hint: say("hint.crown"),
  },
};

const TENSION = { dimension: "line load", low: 0, high: 2 };
const SHEET = {
  thickness: { label: say("sheet.thickness"), dimension: "length", low: 0.005, high: 5, log: true },
  modulus: {
    label: say("sheet.modulus"),
    dimension: "pressure",
    low: 10,
    high: 210000,
    log: true,
    hint: say("hint.sheet-modulus"),
  },
  modulus_thickness: {
    label: say("sheet.across"),
    dimension: "pressure",
    low: 1,
    high: 210000,
    log: true,
    hint: say("hint.sheet-across"),
  },
  poisson: { label: say("input.poisson"), dimension: "ratio", low: 0, high: 0.5 },
  tension_in: { ...TENSION, label: say("sheet.tension-in") },
  tension_out: { ...TENSION, label: say("sheet.tension-out") },
  friction_upper: { label: say("sheet.friction-upper"), dimension: "ratio", low: 0.02, high: 2 },
  friction_lower: { label: say("sheet.friction-lower"), dimension: "ratio", low: 0.02, high: 2 },
};

const DEGREES = { dimension: "temperature", low: -20, high: 150 };
const FILM = { label: say("heat.film"), dimension: "film coefficient", low: 1, high: 2000, log: true, hint: say("hint.film") };
const THERMAL = {
  conductivity: { label: say("heat.conductivity"), dimension: "thermal conductivity", low: 0.05, high: 400, log: true },
  density: { label: say("heat.density"), dimension: "density", low: 500, high: 12000 },
  heat_capacity: { label: say("heat.capacity"), dimension: "heat capacity", low: 200, high: 3000 },
  expansion: { label: say("heat.expansion"), dimension: "thermal expansion", low: 0, high: 0.0004 },
};
const COOLING = {
  film: FILM,
  core: { ...DEGREES, label: say("heat.held") },
  "core.coolant": { ...DEGREES, label: say("heat.coolant") },
  "core.film": { ...FILM, label: say("heat.inner-film"), hint: null, high: 20000 },
  "shell.thickness": { label: say("heat.shell"), dimension: "length", low: 0.5, high: 100, log: true },
};
const HEAT = {
  ambient: { ...DEGREES, label: say("heat.ambient"), high: 80 },
  start: { ...DEGREES, label: say("heat.start") },
  "sheet.temperature": { ...DEGREES, label: say("heat.entry") },
};

const POINTS = {
  temperature: { ...MATERIAL.temperature },
  factor: { label: say("input.factor"), dimension: "ratio", low: 1e-6, high: 1e6, log: true, hint: null },
};

/** The input at a path: {path, label, dimension, low, high, log, hint, factor}; shown is factor times the value. */
export function inputAt(path, tree) {
  const last = path.replace(/^.*?((?:shift|energy)\.[a-z0-9_]+|[a-z_]+)$/, "$1");
  const start = { path, factor: 1 };
  if (path.startsWith("sheet.")) return { ...start, ...SHEET[path.slice(6)] };
  if (path.startsWith("face.")) return { ...start, ...FACE[path.replace(/^face\.(arms\[.*\]\.)?/, "")] };
  if (path.startsWith("heat.")) return { ...start, ...(HEAT[path.slice(5)] ?? THERMAL[last]) };
  const [, cooling] = path.match(/^(?:upper|lower)\.heat\.(.+)$/) ?? [];
  if (cooling) return { ...start, ...(COOLING[cooling] ?? THERMAL[last]) };
  const [, side, shaft] = path.match(/^(upper|lower)\.shaft\.(.+)$/) ?? [];
  if (shaft) return { ...start, ...SHAFT[shaft], ...shaftRange(shaft, SHAFT[shaft], tree[side]) };
  if (path.startsWith("nip.")) return { ...start, ...NIP[last], ...tractionRange(last, tree) };
  if (path.includes(".points[")) return { ...start, ...POINTS[last] };
  if (path.includes(".terms[")) return { ...start, ...TERMS[last] };
  const hint = path === "upper.radius" ? say("hint.diameter") : null;
  return { ...start, hint, ...(SIZES[last] ?? MATERIAL[last] ?? THERMAL[last]) };
}

/** The name of an input of the face, with its roller. */
export function faceLabel(path, tree) {
  const [, side] = path.match(/^(upper|lower)\./) ?? [];
  const input = inputAt(path, tree);
  return side ? named(say(`roller.${side}`), input).label : input.label;
}

/** Every number of a design that can be varied, for what-if and the inverse: {path, label, ...}. */
export function inputsOf(tree) {
  const paths = Object.keys(NIP)
    .filter((name) => typeof tree.nip[name] === "number")
    .map((name) => `nip.${name}`);
  const sheet = sheetPaths(tree).map((path) => named(say("sheet.title"), inputAt(path, tree)));
  const found = [...paths.map((path) => inputAt(path, tree)), ...sheet];
  for (const side of ["upper", "lower"]) {
    if (typeof tree[side].radius === "number")
      found.push(named(say(`roller.${side}`), inputAt(`${side}.radius`, tree)));
    tree[side].layers.forEach((layer, i) => {
      const several = tree[side].layers.length > 1;
      const where = say(`${several ? "layer" : "covering"}.${side}`, { number: i + 1 });
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
    label: `${where}: ${withinText(input.label)}`,
  };
}

/** A label behind something else; a name keeps its capital. */
export function withinText(label) {
  return label.startsWith("Poisson") ? label : firstInText(label);
}

const FAR = { metric: "m", us: "ft" };
const LEAST_AHEAD = 1e-3; // of 1000: less is rounding
const positive = (value) =>
  value > 0 ? say("faster.upper") : say("faster.lower");

// What a figure means at the size it has.
const MEANINGS = {
  nip_width: () => say("meaning.nip"),
  speed_ratio: (value, units) => {
    const ahead = value ? 1000 * (value - 1) : 0;
    if (Math.abs(ahead) < LEAST_AHEAD) return "";
    const key = ahead > 0 ? "meaning.ratio-ahead" : "meaning.ratio-behind";
    return say(key, { length: number(Math.abs(ahead)), unit: FAR[units.system] });
  },
  creepage: (value) => (value ? say("meaning.creepage", { which: positive(value) }) : ""),
};

/** The answers: key in the flat result, label, dimension, digits, and a hint in plain words. */
export const ANSWERS = [...FIGURES, ...SHEET_FIGURES].map((figure) => ({
  ...said(figure),
  hint: ({ [figure.key]: value }, units) => said(figure).hint + (MEANINGS[figure.key]?.(value, units) ?? ""),
}));

/** The result with every scalar on its first level, as sweeps give it; what is rounding or error only is zero. */
export function flat(result) {
  const { friction, viscous } = result.dissipation;
  const losses = { dissipation_friction: friction, dissipation_viscous: viscous };
  const error = { ...result.error, ...ofSheet(result.sheet?.error) };
  const all = { ...result, ...losses, ...ofSheet(result.sheet), error };
  const isNothing = ({ key, size, has_sign: hasSign }) =>
    isNoise(all[key], all, size) || (hasSign && isLost(all[key], error[key]));
  const cleaned = [...FIGURES, ...SHEET_FIGURES].map((figure) => [figure.key, isNothing(figure) ? 0 : all[figure.key]]);
  return { ...all, ...Object.fromEntries(cleaned) };
}

/** Figures of the sheet, or their errors, under the names that figures of the nip stand beside. */
function ofSheet(values) {
  if (!values) return {};
  const keys = SHEET_FIGURES.map(({ key }) => [key, values[key.replace(/^sheet_/, "")] ?? null]);
  return Object.fromEntries(keys);
}

/** Whether a figure or its error is no more than what rounding leaves beside those of `size`. */
function isNoise(value, all, size) {
  if (value === null || value === undefined) return false;
  const factors = Object.entries(size).map(([name, power]) => Math.abs(all[name] ?? 0) ** power);
  return Math.abs(value) < factors.reduce((product, factor) => product * factor, ROUNDING);
}

/** Whether a figure of either sign is so much less than its own error that nothing is left of it. */
function isLost(value, error) {
  return Boolean(value && error) && Math.abs(value) < LOST * error;
}

/** An estimated error worth showing, or null. */
export function errorOf(all, key) {
  const error = all.error?.[key];
  const { size } = ANSWERS.find((figure) => figure.key === key);
  return error && error > TINY * Math.abs(all[key]) && !isNoise(error, all, size) ? error : null;
}

/** Totals over the face width as {label, text, unit}, of a flat result: what is rounding only in it is zero. */
export function totalsOf(result, system) {
  if (!result.totals) return [];
  return TOTALS.filter(({ key }) => result.totals[key] !== null).map(({ key, label, units }) => {
    const [unit, scale] = units[system];
    const total = result[key] === 0 ? 0 : result.totals[key];
    return { label: totalLabel(key, label), text: number(total / scale), unit: written(unit) };
  });
}
