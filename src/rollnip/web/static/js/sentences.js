// The frequent sentences of the solver in the language of the page; others stay in English.

import { SOLVER_EN } from "./texts/solver-en.js";
import { LANGUAGE, say, sayOr } from "./texts.js";

const HOLE = /\\\{(\w+)\\\}/g;
// The longest first: what fits it, too, is a part of it.
const SENTENCES = Object.entries(SOLVER_EN)
  .filter(([key]) => key.startsWith("solver."))
  .sort(([, one], [, other]) => other.length - one.length);
const CATALOGUE = SENTENCES.map(([key, text]) => {
  const escaped = text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
  return { key, pattern: new RegExp(`^(?:\`[a-z_.]+\` )?${escaped.replace(HOLE, "(?<$1>.*?)")}$`) };
});

/** What the solver says in the language of the page; null where a sentence of it is not among the known ones. */
export function inLanguage(text) {
  if (LANGUAGE === "en") return text;
  return whole(text) ?? oneByOne(text.split(/(?<=\.) (?=[A-Z])/));
}

/** The language that what the solver says stands in on this page. */
export function languageOf(text) {
  return inLanguage(text) === null ? "en" : LANGUAGE;
}

/** A text that is one known message as it stands; null where it is none. */
function whole(text) {
  for (const { key, pattern } of CATALOGUE) {
    const found = text.match(pattern);
    if (!found) continue;
    const holes = Object.entries(found.groups ?? {}).map(([name, value]) => [name, filled(name, value)]);
    if (holes.every(([, value]) => value !== null)) return say(key, Object.fromEntries(holes));
  }
  return null;
}

/** Sentences of several messages in a row; null where one is not known. */
function oneByOne(sentences) {
  if (sentences.length < 2) return null;
  for (let count = sentences.length - 1; count > 0; count -= 1) {
    const first = whole(sentences.slice(0, count).join(" "));
    if (first === null) continue;
    const rest = sentences.slice(count);
    const second = whole(rest.join(" ")) ?? oneByOne(rest);
    if (second !== null) return `${first} ${second}`;
  }
  return null;
}

/** What stands in a hole; a reason ("why") must be known itself, of other words those that are. */
function filled(name, value) {
  const word = sayOr(`word.${value}`, null);
  if (word !== null) return word;
  if (name === "why") return inLanguage(value);
  const parts = value.split(" and ").map(whole);
  return parts.includes(null) ? value : parts.join(say("find.and"));
}
