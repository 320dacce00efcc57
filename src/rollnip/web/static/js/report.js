// The printed page: what was put in, assumed and found.

import { sentenceItems } from "./answers.js";
import { svgOf } from "./charts.js";
import { driving, kindOf, nameOf } from "./design.js";
import { byId, el } from "./dom.js";
import { facePaths } from "./face.js";
import { heatPaths } from "./heat.js";
import { heatTables } from "./heatview.js";
import { bentPicture, printPicture } from "./facedrawing.js";
import { faceRows } from "./faceview.js";
import { drawingOf } from "./files.js";
import { bandOf, partsOf, rangeText } from "./known.js";
import { PLOTS } from "./plots.js";
import { ANSWERS, errorOf, faceLabel, flat, inputAt, totalsOf } from "./quantities.js";
import { sheetPaths } from "./sheet.js";
import { inWords } from "./said.js";
import { say } from "./texts.js";
import { joined, number } from "./units.js";
import { getAt } from "./paths.js";

const DRIVES = {
  free: say("report.free"),
  idler: say("report.idler"),
  traction: say("report.traction"),
  creepage: say("report.creepage"),
  torque: say("report.torque"),
};
const MODELS = {
  shore: say("report.shore"),
  elastic: say("report.elastic"),
  "standard-linear-solid": say("report.sls"),
  prony: say("report.prony"),
  "fractional-zener": say("report.zener"),
  "loss-factor": say("report.loss-factor"),
};
const GEOMETRIES = {
  finite: say("assume.finite"),
  second: say("assume.second"),
  curved: say("assume.curved"),
  corrected: say("assume.corrected"),
  linear: say("assume.linear"),
};
const HARDNESS =
  say("assume.hardness");

/** Fill the page that is printed. `answer` is {tree, result, surfaces, known}. */
export function fillReport(answer, units, palette, date) {
  const { tree, result } = answer;
  const chart = svgOf(PLOTS.pressure(result, units, palette, tree), 620, 350);
  const pictures = [
    picture(drawingOf(answer, { palette, units }), say("report.drawing")),
    picture(chart, say("report.chart")),
  ];
  byId("report").replaceChildren(
    el("h1", { text: nameOf(tree) }),
    el("p", {
      class: "meta",
      text: say("report.head", { version: result.solver.version, date, hash: result.hash }),
    }),
    result.converged
      ? el("span")
      : el("p", {
          class: "alarm",
          text: `${say("alarm.unsound")}. ${inWords(result.solver.status, "", units)}`,
        }),
    el(
      "div",
      { class: "two" },
      el("div", {}, el("h2", { text: say("report.inputs") }), inputs(tree, units)),
      el(
        "div",
        {},
        el("h2", { text: say("report.figures") }),
        figures(answer, units),
        el("h2", { text: say("known.title") }),
        table(partsOf(answer, units)),
      ),
    ),
    el("div", { class: "two" }, ...pictures),
    ...faceParts(answer, units, palette),
    ...heatParts(answer, units),
    el("h2", { text: say("report.assumptions") }),
    el("ul", {}, ...assumptionsOf(tree, result).map((text) => el("li", { text }))),
    ...warnings(result, units),
  );
}

/** Fill it with the reason why there is no report. */
export function fillRefusal(name, why) {
  byId("report").replaceChildren(el("h1", { text: name }), el("p", { class: "alarm", text: why }));
}

/** The face: its figures, the bent rollers, the print of the nip. */
function faceParts({ tree, face }, units, palette) {
  if (!face) return [];
  const look = { width: 680, palette, units };
  const bent = bentPicture(tree, face, look);
  const print = printPicture(face, look);
  const rows = faceRows(face, units).map(({ label, text, unit }) => [label, joined(text, unit)]);
  const inputs = facePaths(tree).map((path) => row(tree, path, units, faceLabel(path, tree)));
  return [
    el("h2", { text: say("report.face") }),
    el("div", { class: "two" }, table(inputs), table(rows)),
    bent.node,
    el("p", { text: say("face.bent", { times: number(bent.times) }) }),
    print.node,
    el("p", { text: say("face.print", { times: number(print.times) }) }),
    el("ul", {}, ...sentenceItems(face.warnings, units)),
  ];
}

/** Heat: its inputs and its figures. */
function heatParts({ tree, heat }, units) {
  if (!heat) return [];
  const inputs = heatPaths(tree).map((path) => row(tree, path, units, faceLabel(path, tree)));
  const said = heat.converged ? heatTables(heat, tree, units) : [el("p", { class: "alarm", text: inWords(heat.status, "", units) })];
  const notes = sentenceItems(heat.warnings, units);
  return [el("h2", { text: say("heat.title") }), table(inputs), ...said, el("ul", {}, ...notes)];
}

function assumptionsOf(tree, { geometry }) {
  const layers = [...tree.upper.layers, ...tree.lower.layers];
  const byHardness = layers.some(({ material: one }) => one.shore_a !== undefined);
  const along = say(tree.face ? "assume.face" : "assume.plane");
  const steady = say(tree.sheet ? "assume.steady-sheet" : "assume.steady");
  return [GEOMETRIES[geometry], along, steady, say("assume.material"), ...(byHardness ? [HARDNESS] : [])];
}

function picture(node, label) {
  node.setAttribute("role", "img");
  node.setAttribute("aria-label", label);
  return node;
}

function warnings({ warnings: list }, units) {
  if (list.length === 0) return [];
  return [el("h2", { text: say("warnings.title") }), el("ul", {}, ...sentenceItems(list, units))];
}

function figures({ result, known }, units) {
  const all = flat(result);
  const rows = ANSWERS.filter(({ key }) => all[key] !== null && all[key] !== undefined).map(
    ({ key, label, dimension, digits }) => {
      const noted = errorOf(all, key);
      const error = noted ? ` ± ${units.error(noted, dimension)}` : "";
      const band = bandOf(known, key);
      const range = band ? ` (${rangeText(band, dimension, units)})` : "";
      return [label, units.text(all[key], dimension, digits) + error + range];
    },
  );
  return table([
    ...rows,
    ...totalsOf(all, units.system).map(({ label, text, unit }) => [label, joined(text, unit)]),
  ]);
}

function inputs(tree, units) {
  const rows = Object.keys(tree.nip).map((name) => row(tree, `nip.${name}`, units));
  rows.push([say("drive.label"), DRIVES[driving(tree)]]);
  if (tree.sheet) rows.push([say("sheet.title")], ...sheetPaths(tree).map((path) => row(tree, path, units)));
  for (const side of ["upper", "lower"]) rows.push(...roller(tree, side, units));
  return table(rows);
}

function roller(tree, side, units) {
  const { radius, layers, core } = tree[side];
  const title = say(`roller.${side}`);
  const rows = [[title], radius === "inf" ? [say("report.shape"), say("body.plane")] : row(tree, `${side}.radius`, units)];
  layers.forEach((layer, i) => {
    rows.push(row(tree, `${side}.layers[${i}].thickness`, units, say("report.layer", { number: i + 1 })));
    rows.push(...material(tree, `${side}.layers[${i}].material`, units));
  });
  if (core) rows.push([say("report.core"), say("report.half-space")], ...material(tree, `${side}.core`, units));
  else rows.push([say("report.core"), say(layers.length ? "report.rigid" : "report.bare")]);
  return rows;
}

function material(tree, path, units) {
  const table = getAt(tree, path);
  const numbers = Object.keys(table)
    .filter((name) => typeof table[name] === "number" && inputAt(`${path}.${name}`, tree).label)
    .map((name) => row(tree, `${path}.${name}`, units));
  const shift = Object.keys(table.shift ?? {})
    .filter((name) => typeof table.shift[name] === "number")
    .map((name) => row(tree, `${path}.shift.${name}`, units));
  const points = (table.shift?.points ?? []).map(({ temperature, factor }) => [
    say("report.factor", { temperature: units.text(temperature, "temperature") }),
    number(factor),
  ]);
  const terms = (table.terms ?? []).map((term, i) => [
    say("material.term", { number: i + 1 }),
    `${units.text(term.modulus, "pressure")}, ${units.text(term.relaxation_time, "time")}`,
  ]);
  return [[say("material.label"), MODELS[kindOf(table)]], ...numbers, ...terms, ...shift, ...points];
}

function row(tree, path, units, label = null) {
  const input = inputAt(path, tree);
  return [label ?? input.label, units.text(getAt(tree, path) * input.factor, input.dimension, 6)];
}

function table(rows) {
  const cells = ([name, value]) =>
    value === undefined
      ? [el("th", { colspan: 2, text: name })]
      : [el("td", { text: name }), el("td", { text: value })];
  return el("table", {}, ...rows.map((one) => el("tr", {}, ...cells(one))));
}
