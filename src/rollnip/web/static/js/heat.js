// How the rollers of a design lose their heat: what a design holds of it. Pure functions.

import { THERMALS } from "./figures.js";
import { getAt, setAt } from "./paths.js";

const SIDES = ["upper", "lower"];
const AMBIENT = 23; // degC
const FILM = 25; // W/(m2 K), of a roller that turns
const COVERING = "natural-rubber-filled";
const NUMBERS = ["conductivity", "density", "heat_capacity", "expansion"];
const KEYS = ["thermal", ...NUMBERS];

export const OWN = "own";
export const METALS = ["steel", "aluminium"];
export const CORES = {
  insulated: "insulated",
  held: 40,
  cooled: { coolant: 15, film: 500 },
};

/** Names of the usual thermal properties. */
export const USUAL = THERMALS.map(({ name }) => name);

/** The design with a heat balance: usual films and usual properties where none are given. */
export function withHeat(tree) {
  const nip = tree.nip.speed === undefined ? { ...tree.nip, speed: 1000 } : tree.nip;
  return heated({ ...tree, nip, heat: { ambient: AMBIENT } });
}

/** The design without its heat balance. */
export function withoutHeat(tree) {
  const { heat: _heat, ...rest } = tree;
  return SIDES.reduce((one, side) => materialsOf(side, one).reduce(plain, setAt(one, `${side}.heat`, undefined)), rest);
}

function plain(tree, path) {
  return setAt(tree, path, bareMaterial(getAt(tree, path)));
}

/** A material without its thermal properties. */
export function bareMaterial(material) {
  return Object.fromEntries(Object.entries(material).filter(([key]) => !KEYS.includes(key)));
}

/** A material with the thermal properties of another one. */
export function warmedAs(material, like) {
  const kept = KEYS.filter((key) => like?.[key] !== undefined).map((key) => [key, like[key]]);
  return { ...bareMaterial(material), ...Object.fromEntries(kept) };
}

/** A design with a heat balance with what every roller and material of it needs; others as they are. */
export function heated(tree) {
  if (!tree.heat) return tree;
  const whole = SIDES.reduce(cooledSide, tree);
  if (!tree.sheet || tree.heat.sheet) return whole;
  return setAt(whole, "heat.sheet", { temperature: tree.heat.ambient, thermal: "paper" });
}

function cooledSide(tree, side) {
  const needs = tree[side].radius !== "inf" && !tree[side].heat;
  const start = needs ? setAt(tree, `${side}.heat`, { film: FILM, core: "insulated" }) : tree;
  const cold = materialsOf(side, tree).filter((path) => !hasThermal(getAt(tree, path)));
  return cold.reduce((one, path) => setAt(one, `${path}.thermal`, COVERING), start);
}

function hasThermal(material) {
  return KEYS.some((key) => material[key] !== undefined);
}

/** Paths of the materials of a roller. */
export function materialsOf(side, tree) {
  const layers = tree[side].layers.map((_layer, i) => `${side}.layers[${i}].material`);
  return tree[side].core ? [...layers, `${side}.core`] : layers;
}

/** "insulated", "held" or "cooled". */
export function coreKind({ core }) {
  if (core === undefined || core === "insulated") return "insulated";
  return typeof core === "number" ? "held" : "cooled";
}

/** The heat of a roller as the page holds it. */
export function coolingOf(heat) {
  return { core: "insulated", ...heat };
}

/** Paths of all numbers of the heat balance of a design that have a control. */
export function heatPaths(tree) {
  if (!tree.heat) return [];
  const own = ["film", "core", "core.coolant", "core.film", "shell.thickness"];
  const rollers = SIDES.flatMap((side) => own.map((name) => `${side}.heat.${name}`));
  const materials = SIDES.flatMap((side) =>
    materialsOf(side, tree).flatMap((path) => NUMBERS.map((name) => `${path}.${name}`)),
  );
  const all = ["heat.ambient", "heat.start", "heat.sheet.temperature", ...rollers, ...materials];
  return all.filter((path) => typeof getAt(tree, path) === "number");
}

/** The design as far as its cold nip goes. */
export function coldPart(tree) {
  return withoutHeat(tree);
}

/** Whether a covering or core of the design makes heat by itself. */
export function losesHeat(tree) {
  return SIDES.some((side) => materialsOf(side, tree).some((path) => getAt(tree, path).model !== "elastic"));
}
