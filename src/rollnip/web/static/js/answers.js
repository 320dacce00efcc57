// The figures: one big, four beside it, all of them below; alarms and warnings.

import { byId, el, withUnit } from "./dom.js";
import { bandOf, headline, rangeText, showKnown } from "./known.js";
import { ANSWERS, errorOf, figureOfNip, flat, nipText, totalsOf } from "./quantities.js";
import { inWords } from "./said.js";
import { languageOf } from "./sentences.js";
import { LANGUAGE, say } from "./texts.js";
import { number } from "./units.js";

const SECONDS = ["peak_pressure", "approach", "dwell_time", "speed_ratio"];
const FEEDS = ["sheet_feed_upper", "sheet_feed_lower"]; // where there is a sheet
const ROOT = document.documentElement;

/** Show {result, known}. */
export function showAnswers(snapshot, units) {
  const { result, known } = snapshot;
  const all = flat(result);
  ROOT.classList.toggle("unsound", !result.converged);
  const { dimension, digits } = figureOfNip("nip_width");
  const nip = units.format(all.nip_width, dimension, digits);
  byId("big").replaceChildren(
    ...withUnit(nip),
    el("span", { class: "error", id: "big-error" }),
  );
  byId("big-hint").textContent = ANSWERS[0].hint(all, units);
  byId("seconds").replaceChildren(...[...SECONDS, ...(result.sheet ? FEEDS : [])].map((key) => second(key, all, units, known)));
  showKnown(snapshot, units);
  showFigures(all, units, known);
  showWarnings(result, units);
  showSolver(result);
}

/**
 * Show how what is shown stands to the inputs: "settled" or "preview" where it is their answer,
 * "computing", "unread" or "none" where it is not.
 */
export function showStanding(standing, snapshot, units) {
  ROOT.dataset.standing = standing;
  const isOld = standing !== "settled" && standing !== "preview";
  ROOT.classList.toggle("old", isOld);
  ROOT.classList.toggle("stale", standing === "none");
  ROOT.classList.toggle("preview", standing === "preview");
  const said = standing === "settled" ? headline(snapshot, units) : say(`state.${standing}`);
  const line = document.getElementById("big-error");
  if (line) line.textContent = said;
  if (isOld) byId("mini").replaceChildren(el("span", { class: "alarm", text: said }));
  else if (snapshot) showMini(snapshot.result, units);
}

function second(key, all, units, known) {
  const { label, dimension, digits } = ANSWERS.find((one) => one.key === key);
  const shown = units.format(all[key], dimension, digits);
  return el(
    "div",
    {},
    el("dt", { text: label }),
    el("dd", { "data-key": key }, ...withUnit(shown), errorText(errorLine(all, key, dimension, units))),
    bandLine(key, dimension, units, known),
  );
}

/** The estimated error of a figure as it stands behind it; "" where it says nothing. */
function errorLine(all, key, dimension, units) {
  const noted = errorOf(all, key);
  return noted ? `± ${units.error(noted, dimension)}` : "";
}

function errorText(error) {
  return error ? el("span", { class: "error", text: error }) : null;
}

/** Between what the material leaves a figure, where that is known. */
function bandLine(key, dimension, units, known) {
  const band = bandOf(known, key);
  return band ? el("dd", { class: "band", text: rangeText(band, dimension, units) }) : null;
}

function showMini(result, units) {
  const bar = byId("mini");
  const text = (key) => el("b", { text: nipText(key, result, units) });
  if (result.converged)
    bar.replaceChildren(
      el("span", {}, say("mini.nip"), text("nip_width")),
      el("span", {}, say("mini.peak"), text("peak_pressure")),
    );
  else bar.replaceChildren(el("span", { class: "alarm", text: say("mini.unsound") }));
}

function showFigures(all, units, known) {
  const shown = ANSWERS.filter(({ key }) => all[key] !== null && all[key] !== undefined);
  const rows = shown.map(({ key, label, dimension, digits, hint }) => {
    const error = errorLine(all, key, dimension, units);
    const band = bandLine(key, dimension, units, known);
    return figure(label, key, units.format(all[key], dimension, digits), error, hint(all, units), band);
  });
  const totals = totalsOf(all, units.system).map(({ label, text, unit }) =>
    figure(label, null, { text, unit }, "", ""),
  );
  byId("figures").replaceChildren(...rows, ...totals);
}

function figure(label, key, shown, error, hint, band = null) {
  return el(
    "dl",
    { class: "figure" },
    el("dt", { text: label }),
    el(
      "dd",
      { "data-figure": key },
      ...withUnit(shown),
      errorText(error),
    ),
    band,
    hint ? el("dd", { class: "note", text: hint }) : null,
  );
}

/** Reservations of the model. */
function showWarnings(result, units) {
  byId("warnings").replaceChildren(...sentenceItems(result.warnings, units));
  byId("warnings-card").hidden = result.warnings.length === 0;
  byId("warnings-english").textContent = foreignHint(result.warnings);
}

/** That some sentences of the solver stand in English; "" where all are in the language of the page. */
export function foreignHint(sentences) {
  return sentences.some((text) => languageOf(text) !== LANGUAGE) ? say("solver.english") : "";
}

/** Sentences of the solver as items of a list, each marked with the language that it stands in. */
export function sentenceItems(sentences, units) {
  return sentences.map((text) => el("li", { text: inWords(text, "", units), lang: languageOf(text) }));
}

function showSolver({ solver, geometry }) {
  const change = say("solver.change", {
    time: number(1000 * solver.seconds, 2),
    elements: solver.elements,
    residual: number(solver.residual, 2),
  });
  byId("solver-line").textContent =
    say("solver.line", { version: solver.version, geometry, change });
}

/** An alarm above everything: a title, sentences, and elements below them. */
export function alarm(title, sentences, ...more) {
  const key = JSON.stringify([title, sentences]);
  const box = byId("alarm");
  if (box.dataset.said === key && box.firstChild) return; // said already: it is not read out again
  box.dataset.said = key;
  box.replaceChildren(
    el(
      "div",
      { class: "alarm" },
      el("b", { text: title }),
      ...sentences.map((text) => el("p", { text })),
      ...more,
    ),
  );
}

export function clearAlarm() {
  byId("alarm").replaceChildren();
}

/** That an answer is none. */
export function unsoundAlarm({ solver }, units) {
  alarm(say("alarm.unsound"), [inWords(solver.status, "", units)]);
}

/** What a screen reader hears when an answer settles. */
export function announce(result, units) {
  const sound = result.converged ? "" : say("live.unsound");
  const warned = result.warnings.length
    ? say(result.warnings.length > 1 ? "live.warnings" : "live.warning", { count: result.warnings.length })
    : "";
  byId("live").textContent =
    sound +
    say("live.answer", {
      nip: nipText("nip_width", result, units),
      peak: nipText("peak_pressure", result, units),
    }) +
    warned;
}
