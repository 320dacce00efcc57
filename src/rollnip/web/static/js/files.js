// Files out of the page and into it.

import { image } from "./charts.js";
import { nameOf } from "./design.js";
import { pairPicture, words } from "./drawing.js";
import { svg } from "./dom.js";
import { facePaths } from "./face.js";
import { faceRows } from "./faceview.js";
import { MORE_FIGURES } from "./figures.js";
import { heatPaths } from "./heat.js";
import { heatRows } from "./heatview.js";
import { bandOf } from "./known.js";
import { getAt } from "./paths.js";
import { ANSWERS, curveName, faceLabel, flat, inputAt, inputsOf, totalsOf } from "./quantities.js";
import { sectionCaption, sectionPicture, windowOf } from "./section.js";
import { say } from "./texts.js";

const PROFILES = Object.entries(MORE_FIGURES.profile).map(([key, { dimension }]) => [
  key === "x" ? key : curveName("profile", key),
  key,
  dimension,
]);

/** Give a text or blob to the user as a file. */
export function download(name, content, type = "text/plain") {
  const blob = content instanceof Blob ? content : new Blob([content], { type });
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/** A file name from the design's name. */
export function fileName(tree, ending) {
  const stem = nameOf(tree)
    .toLowerCase()
    .replace(/[^a-z0-9]+/g, "-")
    .replace(/^-+|-+$/g, "");
  return `${stem || "nip"}.${ending}`;
}

/** The curves as CSV, units in the header, in the units shown. */
export function profilesCsv(result, units) {
  const columns = PROFILES.filter(([, key]) => result.profiles[key]);
  const head = columns.map(([name, , dimension]) => `${name} [${units.of(dimension).name}]`);
  const lists = columns.map(([, key, dimension]) => units.list(result.profiles[key], dimension));
  const rows = lists[0].map((_x, i) => lists.map((list) => plainNumber(list[i])));
  return table([head, ...rows]);
}

/** The key figures as CSV: with what is known about each, the inputs, the model, the warnings. */
export function figuresCsv({ tree, result, known, face, heat }, units) {
  const all = flat(result);
  const shown = ANSWERS.filter(({ key }) => all[key] !== null && all[key] !== undefined);
  const rows = shown.map(({ key, label, dimension }) => {
    const error = all.error?.[key];
    const { name, scale } = units.of(dimension);
    const band = (bandOf(known, key) ?? []).map((value) => plainNumber(units.shown(value, dimension)));
    const value = plainNumber(units.shown(all[key], dimension));
    return [label, value, name, error ? plainNumber(error / scale) : "", band[0] ?? "", band[1] ?? ""];
  });
  const totals = totalsOf(all, units.system).map(({ label, text, unit }) => [label, text, unit]);
  const inputs = inputsOf(tree).map(({ path, label, dimension, factor }) => {
    const value = units.shown(getAt(tree, path) * factor, dimension);
    return [say("csv.input", { label }), plainNumber(value), units.of(dimension).name];
  });
  const along = face ? faceRows(face, units).map(({ label, text, unit }) => [label, text, unit]) : [];
  const warm = heat?.converged ? heatLines(heat, tree, units) : [];
  const others = [...facePaths(tree), ...heatPaths(tree)].map((path) => {
    const { dimension, factor } = inputAt(path, tree);
    const value = plainNumber(units.shown(getAt(tree, path) * factor, dimension));
    return [say("csv.input", { label: faceLabel(path, tree) }), value, units.of(dimension).name];
  });
  const warnings = [...result.warnings, ...(face?.warnings ?? []), ...(heat?.warnings ?? [])].map((text, i) => [say("csv.warning", { number: i + 1 }), text]);
  return table(
    [
      [say("csv.figure"), say("csv.value"), say("csv.unit"), say("csv.error"), say("csv.low"), say("csv.high")],
      ...rows,
      ...totals,
      ...along,
      ...warm,
      [say("csv.converged"), String(result.converged)],
      [say("csv.geometry"), result.geometry],
      [say("csv.design"), nameOf(tree)],
      ...inputs,
      ...others,
      ...warnings,
    ].map((row) => [...row, ...Array(6 - row.length).fill("")]),
  );
}

/** The figures of heat, a line for each roller and for the cold and the warm nip. */
function heatLines(heat, tree, units) {
  const { temperatures, powers, nip } = heatRows(heat, tree, units);
  const lines = (rows, heads) =>
    rows.flatMap(({ label, cells }) => cells.map(({ text, unit }, i) => [`${label}, ${heads[i]}`, text, unit]));
  const rollers = ["upper", "lower"].map((side) => say(`roller.${side}`));
  return [...lines([...temperatures, ...powers], rollers), ...lines(nip, [say("heat.cold"), say("heat.warm")])];
}

/** A curve of a chart as CSV: a column for each line. */
export function chartCsv(figure) {
  const lines = figure.data.filter((one) => one.name && one.x);
  const rows = lines.flatMap((one) =>
    one.x.map((x, i) => [one.name, plainNumber(x), plainNumber(one.y[i])]),
  );
  return table([[say("csv.curve"), figure.layout.xaxis.title.text, figure.layout.yaxis.title.text], ...rows]);
}

/** Rows of numbers and texts as CSV. */
export function rowsCsv(rows) {
  return table(rows.map((row) => row.map((cell) => (typeof cell === "string" ? cell : plainNumber(cell)))));
}

function plainNumber(value) {
  return value === null || value === undefined ? "" : String(Number(value.toPrecision(9)));
}

function table(rows) {
  const cell = (text) => (/[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text);
  return `${rows.map((row) => row.map(cell).join(",")).join("\r\n")}\r\n`;
}

/** A chart as a file, "PNG" or "SVG", in light colours on white. */
export async function saveChart(figure, format, name) {
  const kind = format.toLowerCase();
  const address = await image(figure, kind);
  download(name, await (kind === "svg" ? blobOfSvg(address) : pngOf(address)));
}

function blobOfSvg(address) {
  const text = decodeURIComponent(address.slice(address.indexOf(",") + 1));
  return new Blob([text], { type: "image/svg+xml" });
}

function pngOf(address) {
  const bytes = Uint8Array.from(atob(address.slice(address.indexOf(",") + 1)), (letter) =>
    letter.charCodeAt(0),
  );
  return new Blob([bytes], { type: "image/png" });
}

/** Both drawings and the name of the design as the text of one SVG. */
export function drawingSvg(answer, look) {
  return new XMLSerializer().serializeToString(drawingOf(answer, look));
}

/** The same as an element. */
export function drawingOf({ tree, result, surfaces }, look) {
  const [width, height, top] = [900, 430, 34];
  const whole = svg("svg", {
    xmlns: "http://www.w3.org/2000/svg",
    viewBox: `0 0 ${width} ${height}`,
    width,
    height,
    "font-family": "sans-serif",
  });
  whole.append(svg("rect", { width, height, fill: look.palette.ground }));
  const sound = result.converged ? "" : say("drawing.unsound");
  whole.append(
    words(12, 23, sound + nameOf(tree), {
      anchor: "start",
      size: 16,
      weight: 600,
      fill: result.converged ? look.palette.ink : look.palette.alert,
    }),
  );
  const pair = pairPicture(tree, result, windowOf(result), { ...look, width: 290, height: height - top });
  const nip = sectionPicture(tree, result, surfaces, { ...look, width: 590, height: height - top });
  if (tree.sheet)
    whole.append(
      words(width - 12, 23, sectionCaption(tree, result, 590), { anchor: "end", fill: look.palette.muted }),
    );
  whole.append(placed(pair, 0, top), placed(nip, 310, top));
  return whole;
}

function placed(node, x, y) {
  node.setAttribute("x", x);
  node.setAttribute("y", y);
  return node;
}

/** An SVG text as a PNG blob, twice as fine as the screen. */
export async function rasterOf(text) {
  const picture = new Image();
  picture.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(text)}`;
  await picture.decode();
  const canvas = document.createElement("canvas");
  canvas.width = 2 * picture.width;
  canvas.height = 2 * picture.height;
  canvas.getContext("2d").drawImage(picture, 0, 0, canvas.width, canvas.height);
  return new Promise((resolve) => {
    canvas.toBlob(resolve, "image/png");
  });
}
