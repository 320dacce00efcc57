// What the server says, in the words and units of the page.

import { inLanguage } from "./sentences.js";
import { say } from "./texts.js";
import { written } from "./units.js";

const MODEL = /`?[Gg]eometry (?:= )?"(second|finite|curved|corrected|linear)"`?/g;
const NUMBER = String.raw`([-\u2212]?\d+(?:\.\d+)?(?:e[+-]?\d+)?)`;
const TIMES = new RegExp(`${NUMBER} (to|bis) ${NUMBER} s(?![\\w/])`, "g");
const DWELL = new RegExp(`(dwell time|Verweilzeit) ${NUMBER} s(?![\\w/])`, "g");
const SAID = ["line load", "speed", "length", "pressure", "temperature"]; // with longer units first

/** A sentence of the server about the value at `path`, `{dimension, factor}` its input. */
export function inWords(message, path, units, input = null) {
  if (message.includes("both be bare rigid cores")) return say("said.bare");
  const thick = message.match(new RegExp(`thinner in all than the radius ${NUMBER} mm, got ${NUMBER} mm`));
  if (thick) {
    const [most, is] = [thick[1], thick[2]].map((text) => units.text(Number(text), "length"));
    return say("said.thick", { most, is, diameter: units.text(2 * Number(thick[1]), "length") });
  }
  const dimensions = new Map(SAID.map((dimension) => [written(units.table[dimension].base), dimension]));
  const measured = new RegExp(`${NUMBER} (${[...dimensions.keys()].join("|")})(?![\\w/])`, "g");
  const isRadius = /(^|\.)radius$/.test(path ?? "");
  const time = (number) => units.text(Number(number), "time");
  const doubled = (number) => (isRadius ? 2 : 1) * number;
  return (inLanguage(message) ?? message)
    .replace(/^`[a-z_.]+` (?=must|needs|need|is)/, "")
    .replace(MODEL, (_text, model) => say("said.model", { model: say(`geometry.${model}`) }))
    .replace(/`?approach`? must be smaller than the radius/, say("said.approach"))
    .replace(/of its radius\b/g, say("said.of-radius"))
    .replace(/friction \* load\b/g, say("said.friction-load"))
    .replace(TIMES, (_text, first, word, last) => `${time(first)} ${word} ${time(last)}`)
    .replace(DWELL, (_text, name, number) => `${name} ${time(number)}`)
    .replace(measured, (_text, number, unit) => units.text(doubled(Number(number)), dimensions.get(unit)))
    .replace(new RegExp(`(got|gegeben ist) ${NUMBER}(?=\\.?$| with )`), (text, got, number) =>
      input && Number.isFinite(Number(number))
        ? `${got} ${units.text(Number(number) * input.factor, input.dimension)}`
        : text,
    );
}
