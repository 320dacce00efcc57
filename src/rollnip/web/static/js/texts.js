// The texts of the page in the language chosen: files of messages, NAME-en.js and NAME-de.js for a view.

import { DE } from "./texts/de.js";
import { EN } from "./texts/en.js";
import { FACE_DE } from "./texts/face-de.js";
import { FACE_EN } from "./texts/face-en.js";
import { HEAT_DE } from "./texts/heat-de.js";
import { HEAT_EN } from "./texts/heat-en.js";
import { LIBRARY_DE } from "./texts/library-de.js";
import { PATCH_DE } from "./texts/patch-de.js";
import { PATCH_EN } from "./texts/patch-en.js";
import { SOLVER_DE } from "./texts/solver-de.js";
import { SOLVER_EN } from "./texts/solver-en.js";
import { remembered } from "./saved.js";

const MESSAGES = {
  en: { ...EN, ...FACE_EN, ...HEAT_EN, ...PATCH_EN, ...SOLVER_EN },
  de: { ...DE, ...FACE_DE, ...HEAT_DE, ...PATCH_DE, ...SOLVER_DE, ...LIBRARY_DE },
};
const HOLE = /\{(\w+)\}/g;

/** The language of the page: as chosen in this browser, else German where the browser is German. */
export const LANGUAGE = choose();

function choose() {
  const own = navigator.language?.startsWith("de") ? "de" : "en";
  const wanted = remembered("language") ?? own;
  const language = wanted in MESSAGES ? wanted : "en";
  document.documentElement.lang = language;
  return language;
}

/** The message of a key, its {holes} filled; a key without a message is an error of the page. */
export function say(key, values = {}) {
  const message = MESSAGES[LANGUAGE][key];
  if (message === undefined) throw new Error(`There is no message "${key}".`);
  return message.replace(HOLE, (hole, name) => (name in values ? String(values[name]) : hole));
}

/** The message of a key, or a text of the server where the language has none of its own. */
export function sayOr(key, text) {
  return MESSAGES[LANGUAGE][key] ?? text;
}

/** An entry of a list of the server, "example" or "library", in the language of the page. */
export function translated(kind, entry) {
  const key = `${kind}.${entry.name}`;
  const title = sayOr(key, entry.title);
  const whole = { ...entry, title, description: sayOr(`${key}.hint`, entry.description) };
  return entry.case ? { ...whole, case: { ...entry.case, title } } : whole;
}

/** A label within a sentence: German nouns keep their capital. */
export function inText(label) {
  return LANGUAGE === "de" ? label : label.toLowerCase();
}

/** The same where only the first letter is a capital for standing first. */
export function firstInText(label) {
  return LANGUAGE === "de" ? label : label.charAt(0).toLowerCase() + label.slice(1);
}

/** Put the messages into the elements of the page that name one. */
export function fillPage() {
  for (const node of document.querySelectorAll("[data-say]")) node.textContent = say(node.dataset.say);
  for (const node of document.querySelectorAll("[data-say-label]"))
    node.setAttribute("aria-label", say(node.dataset.sayLabel));
  for (const node of document.querySelectorAll("[data-say-title]"))
    node.title = say(node.dataset.sayTitle);
  for (const node of document.querySelectorAll("[data-say-placeholder]"))
    node.placeholder = say(node.dataset.sayPlaceholder);
}
