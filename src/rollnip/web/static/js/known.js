// What is known about a figure: its numerical error, the model, the band of the material.

import { byId, el } from "./dom.js";
import { errorOf } from "./quantities.js";
import { say } from "./texts.js";
import { number } from "./units.js";

const SAME = 1e-3; // of a figure: a band that is no wider says nothing

/** [lowest, highest] of a figure within the bands of the materials, or null. */
export function bandOf(known, key) {
  const band = known?.figures?.[key];
  return band && band[1] - band[0] > SAME * Math.abs(band[1]) ? band : null;
}

/** "3.1 to 7.3 MPa" of two values. */
export function rangeText([low, high], dimension, units, digits = 3) {
  return say("known.range", {
    low: units.format(low, dimension, digits).text,
    high: units.text(high, dimension, digits),
  });
}

/** The line under the headline: the numerical error, and what else the nip width is known within. */
export function headline({ result, known }, units) {
  const error = result.error?.nip_width;
  const numerical = say("known.error", { error: error ? units.error(error, "length") : "0" });
  return [numerical, beyondNumerical(result, known, units)].filter(Boolean).join("; ");
}

/** The widest of what the material and the model leave open; "" until it is known. */
function beyondNumerical(result, known, units) {
  if (!known) return "";
  const band = bandOf(known, "nip_width");
  if (band) return say("known.headline", { range: rangeText(band, "length", units) });
  if (!known.is_judged) return say("known.unjudged");
  const model = (known.accuracy.nip_width ?? 0) * result.nip_width;
  return say("known.model-error", { error: units.error(model, "length") });
}

/** The three parts of what is known, as [term, sentence]. */
export function partsOf({ result, known }, units) {
  if (!known) return [];
  const error = errorOf(result, "nip_width");
  const model = say(`geometry.${known.geometry}`);
  const share = number(100 * (known.accuracy.nip_width ?? 0), 2);
  const parts = [
    [say("known.material"), materialText(known, units)],
    [
      say("known.model"),
      known.is_judged ? say("known.judged", { model, share }) : say("known.not-judged", { model }),
    ],
    [say("known.numerical"), `± ${error ? units.error(error, "length") : "0"}`],
  ];
  return parts;
}

function materialText({ materials, message, figures }, units) {
  if (materials.length === 0) return say("known.given");
  const bands = materials.map(({ low, high }) => rangeText([low, high], "pressure", units, 2));
  const text = say("known.moduli", { bands: [...new Set(bands)].join(", ") });
  return Object.keys(figures).length ? text : `${text} ${message}`;
}

/** Show the parts below the headline. */
export function showKnown(snapshot, units) {
  const rows = partsOf(snapshot, units).map(([term, text]) =>
    el("div", {}, el("dt", { text: term }), el("dd", { text })),
  );
  byId("known").replaceChildren(...rows);
}
