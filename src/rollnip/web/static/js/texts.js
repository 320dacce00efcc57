// The texts of the page in the language chosen: one file of messages for each language.

import { DE } from "./texts/de.js";
import { EN } from "./texts/en.js";

/** The languages and their names. */
export const LANGUAGES = { en: "English", de: "Deutsch" };

const MESSAGES = { en: EN, de: DE };
const HOLE = /\{(\w+)\}/g;

let chosen = "en";

/** Choose the language of the page; an unknown one is English. */
export function speak(language) {
  chosen = language in MESSAGES ? language : "en";
  document.documentElement.lang = chosen;
  return chosen;
}

/** The language that is spoken. */
export function language() {
  return chosen;
}

/** The message of a key, its {holes} filled; a key without a message is an error of the page. */
export function say(key, values = {}) {
  const message = MESSAGES[chosen][key];
  if (message === undefined) throw new Error(`There is no message "${key}".`);
  return message.replace(HOLE, (_hole, name) => String(values[name]));
}
