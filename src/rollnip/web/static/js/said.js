// What the server says, in the words and units of the page.

import { inLanguage } from "./sentences.js";
import { say, sayOr } from "./texts.js";
import { DIGITS, askedAs, written } from "./units.js";

const MODEL = /`?[Gg]eometry (?:= )?"(second|finite|curved|corrected|linear)"`?/g;
const ENDS = /"(plane|edge|covering)"/g;
const NUMBER = String.raw`([-\u2212]?\d+(?:\.\d+)?(?:e[+-]?\d+)?)`;
const SAID = ["line load", "speed", "length", "pressure", "temperature"]; // with longer units first
const TIMES = new RegExp(`${NUMBER} (to|bis) ${NUMBER} s(?![\\w/])`, "g");
const DWELL = new RegExp(`(dwell time|Verweilzeit) ${NUMBER} s(?![\\w/])`, "g");
const GOT = new RegExp(`(got|gegeben (?:ist|sind)(?: zusammen)?) ${NUMBER}(?=[.,;:](?: |$)|$| with | mit | bei | in all)`);
const PLACE = / \(in `(?:upper|lower)\.\w+`\)(?=\.?$)/; // the page names the place itself
const INFINITE = /got "[+-]?(?:inf|infinity|infinite|\u221e)( mm| in)?"/i;
const CLOSE = 8; // digits of values that are the same to fewer

/** A sentence of the server about the value at `path`, `{dimension, factor}` its input. */
export function inWords(message, path, units, input = null) {
  const special = specially(message, path, units);
  if (special !== null) return special;
  const bare = message.replace(PLACE, "");
  const text = (inLanguage(bare) ?? bare)
    .replace(/^`[a-z_.]+` (?=must|needs|need|is)/, "")
    .replace(MODEL, (_text, model) => say("said.model", { model: say(`geometry.${model}`) }))
    .replace(ENDS, (_text, ends) => say("said.ends", { ends: say(`face.ends-${ends}`) }));
  const isRadius = /(^|\.)radius$/.test(path ?? "");
  return outsideQuotes(text, (part) => worded(inUnits(part, units, input, isRadius)));
}

/** Sentences that speak of what the page does not show, or calls otherwise; null for all others. */
function specially(message, path, units) {
  if (message.includes("both be bare rigid cores")) return say("said.bare");
  const thick = message.match(new RegExp(`thinner in all than the radius ${NUMBER} mm, got ${NUMBER} mm`));
  if (thick) {
    const [most, is] = [thick[1], thick[2]].map((text) => units.text(Number(text), "length"));
    return say("said.thick", { most, is, diameter: units.text(2 * Number(thick[1]), "length") });
  }
  const [, side] = path?.match(/^(upper|lower)\.radius$/) ?? [];
  const large = side && message.match(new RegExp(`at most ${NUMBER} mm \\(or inf.*got ${NUMBER}`));
  if (large) {
    const [most, got] = [large[1], large[2]].map((text) => units.text(2 * Number(text), "length"));
    return say("said.radius", { most, got, ...planeChoice(side) });
  }
  if (side && INFINITE.test(message)) return say("said.plane", planeChoice(side));
  const pulled = path === "sheet.tension_in" && message.match(new RegExp(`added to the pull .* = ${NUMBER} N/mm .* got ${NUMBER} in all`));
  if (!pulled) return null;
  const [limit, got] = [pulled[1], pulled[2]].map((text) => units.text(Number(text), "line load"));
  return say("said.pulled", { limit, got });
}

/** Where the page has a plane instead of a roller. */
function planeChoice(side) {
  return { plane: say("body.is-plane", { side: say(`side.${side}`) }), group: say("group.advanced") };
}

/** A text changed but for what stands in quotes: that is quoted as it was typed. */
function outsideQuotes(text, change) {
  return text
    .split(/("[^"]*")/)
    .map((part, i) => (i % 2 ? part : change(part)))
    .join("");
}

/** Names of the case file as words. */
function worded(text) {
  return text
    .replace(/`?approach`? must be smaller than the radius/, say("said.approach"))
    .replace(/of its radius\b/g, say("said.of-radius"))
    .replace(/friction \* load\b/g, say("said.friction-load"))
    .replace(/`([^`]+)`/g, (_text, name) => sayOr(`name.${name}`, name.replace(/_/g, " ")));
}

/** Numbers with a unit, ranges of them, and the value that was given, as the page shows them. */
function inUnits(text, units, input, isRadius) {
  const dimensions = new Map(SAID.flatMap((dimension) => spellings(units, dimension)));
  const own = input ? spellings(units, input.dimension) : [];
  for (const [unit, dimension] of own) dimensions.set(unit, dimension);
  const names = [...dimensions.keys()].sort((one, other) => other.length - one.length).map(escaped);
  const unit = `(${names.join("|")})(?![\\w/])`;
  const measured = new RegExp(`${NUMBER} ${unit}`, "g");
  const ranges = new RegExp(`${NUMBER} (to|bis|and|und) ${NUMBER} ${unit}`, "g");
  const time = (number) => units.text(Number(number), "time");
  const factor = (dimension) => (isRadius && dimension === "length" ? 2 : 1);
  const said = [...text.matchAll(measured)].map(([, number, name]) => [Number(number), dimensions.get(name)]);
  const given = text.match(GOT);
  if (input && given) said.push([Number(given[2]), input.dimension]);
  const digits = digitsFor(said, units);
  const shown = (number, name) => {
    const dimension = dimensions.get(name);
    return units.text(factor(dimension) * Number(number), dimension, digits);
  };
  return text
    .replace(TIMES, (_text, first, word, last) => `${time(first)} ${word} ${time(last)}`)
    .replace(DWELL, (_text, name, number) => `${name} ${time(number)}`)
    .replace(ranges, (_text, low, word, high, name) => `${shown(low, name)} ${word} ${shown(high, name)}`)
    .replace(measured, (_text, number, name) => shown(number, name))
    .replace(GOT, (whole, got, number) =>
      input?.dimension ? `${got} ${units.text(Number(number) * input.factor, input.dimension, digits)}` : whole,
    );
}

/** More digits where two different values would look the same. */
function digitsFor(said, units) {
  const isSame = ([one, dimension], [other, like]) =>
    one !== other && dimension === like && units.text(one, dimension) === units.text(other, dimension);
  return said.some((one, i) => said.slice(i + 1).some((other) => isSame(one, other))) ? CLOSE : DIGITS;
}

/** [unit, dimension] for each way in which the server writes the base unit of a dimension. */
function spellings(units, dimension) {
  const base = units.table[askedAs(dimension)]?.base;
  return base ? [...new Set([base, written(base)])].map((unit) => [unit, dimension]) : [];
}

function escaped(text) {
  return text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
}
