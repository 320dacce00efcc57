// The frequent sentences of the solver in the language of the page; others stay in English.

import { SOLVER_EN } from "./texts/solver-en.js";
import { LANGUAGE, say, sayOr } from "./texts.js";

const HOLE = /\\\{(\w+)\\\}/g;
const SENTENCES = Object.entries(SOLVER_EN).filter(([key]) => key.startsWith("solver."));
const CATALOGUE = SENTENCES.map(([key, text]) => {
  const escaped = text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
  return { key, pattern: new RegExp(`^(?:\`[a-z_.]+\` )?${escaped.replace(HOLE, "(?<$1>.+?)")}$`) };
});

/** A sentence of the solver in the language of the page; null where it is not among the known ones. */
export function inLanguage(sentence) {
  if (LANGUAGE === "en") return sentence;
  for (const { key, pattern } of CATALOGUE) {
    const found = sentence.match(pattern);
    if (!found) continue;
    const holes = Object.entries(found.groups ?? {}).map(([name, value]) => [name, sayOr(`word.${value}`, value)]);
    return say(key, Object.fromEntries(holes));
  }
  return null;
}

/** The language that a sentence of the solver stands in on this page. */
export function languageOf(sentence) {
  return inLanguage(sentence) === null ? "en" : LANGUAGE;
}
