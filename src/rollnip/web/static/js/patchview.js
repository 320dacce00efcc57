// A patch: rollers that touch in three dimensions, such as wheels, crowned and short rollers.

import { sentenceItems } from "./answers.js";
import { sentencesOf } from "./api.js";
import { Chart } from "./charts.js";
import { button, el } from "./dom.js";
import { download, fileName } from "./files.js";
import { patchCase, patchDrive, patchPress, patchStart, shapeAcross, SIDES } from "./patch.js";
import { patchInputs } from "./patchinputs.js";
import { gapMap, patchColumns, patchRows, pressureMap, slipMap, zonesMap } from "./patchplots.js";
import { figureIn } from "./quantities.js";
import { inWords } from "./said.js";
import { say } from "./texts.js";
import { number } from "./units.js";

const MAPS = { pressure: pressureMap, zones: zonesMap, slipping: slipMap, gap: gapMap };
const OF_FRICTION = ["zones", "slipping"];

/** The view "Patch". */
export class PatchView {
  constructor(app) {
    this.id = "patch";
    this.title = say("patch.title");
    this.app = app;
    this.controls = [];
    const start = () => app.store.design({ patch: patchStart(app.store.state.view.system) });
    this.none = el(
      "div",
      { class: "empty" },
      el("p", { text: say("patch.none") }),
      button(say("patch.give"), start, { kind: "main", id: "give-patch" }),
    );
    this.inputs = el("div", { class: "patch-inputs" });
    this.said = el("p", { class: "wrong", id: "patch-said", role: "status" });
    this.grid = el("p", { class: "hint", id: "patch-grid" });
    this.heard = el("p", { class: "sr", role: "status", id: "patch-live" });
    this.charts = Object.fromEntries(Object.keys(MAPS).map((name) => [name, new Chart(el("div", { class: "chart low", id: `chart-patch-${name}` }))]));
    this.maps = el("div", { class: "patch-maps" }, ...Object.keys(MAPS).map((name) => this.figureOf(name)));
    this.table = el("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": say("patch.figures") });
    this.notes = el("ul", { class: "warnings", id: "patch-notes" });
    this.whole = el(
      "div",
      { class: "patch" },
      el("p", { class: "hint", text: say("patch.hint") }),
      this.inputs,
      this.said,
      this.grid,
      this.heard,
      this.maps,
      this.notes,
      this.table,
      this.foot(),
    );
    this.node = el("div", {}, this.none, this.whole);
  }

  figureOf(name) {
    const save = (format) =>
      button(format, () => this.save(name, format), {
        kind: "small",
        id: `patch-${name}-${format.toLowerCase()}`,
        label: say("chart.save", { format }),
      });
    return el(
      "figure",
      { id: `patch-${name}` },
      this.charts[name].node,
      el("figcaption", {}, el("span", { text: say(`patch.caption-${name}`) }), el("span", { class: "row" }, save("PNG"), save("SVG"))),
    );
  }

  foot() {
    const remove = () => this.app.store.design({ patch: null });
    return el(
      "div",
      { class: "row" },
      button("CSV", () => this.save("pressure", "CSV"), { kind: "small", id: "patch-csv", label: say("patch.csv") }),
      button(say("patch.case"), () => this.saveCase(), { kind: "small", id: "patch-case" }),
      button(say("patch.remove"), remove, { kind: "small", id: "patch-remove" }),
    );
  }

  /** Called with every answer of the nip; the patch has its own. */
  show() {
    this.refresh();
  }

  /** Show the patch of the design at hand: its inputs, and its answer where that is there. */
  refresh() {
    if (!this.node.isConnected) return;
    const { case: tree, patch } = this.app.store.state;
    this.none.hidden = Boolean(patch);
    this.whole.hidden = !patch;
    if (!patch) return;
    this.build(patch);
    for (const control of this.controls) control.refresh(tree);
    const failure = this.app.patches.failureOf(tree, patch);
    const { coarse, fine } = this.app.patches.of(tree, patch);
    const result = fine ?? coarse;
    const units = this.app.units();
    this.said.textContent = failure ? this.sentence(failure) : "";
    this.said.hidden = !failure;
    if (result) this.shown = { tree, result, coarse, isFine: Boolean(fine) };
    const isOld = Boolean(failure) || !result;
    for (const node of [this.maps, this.table, this.notes]) {
      node.hidden = !this.shown;
      node.classList.toggle("old", isOld);
    }
    for (const chart of Object.values(this.charts)) chart.node.classList.toggle("old", isOld);
    this.grid.textContent = this.state(failure, fine, coarse);
    if (fine && this.told !== fine) this.announce(fine, units);
    if (this.shown) this.draw(units);
  }

  /** What stands below the inputs: on which grid the answer is, and how well it is known. */
  state(failure, fine, coarse) {
    if (failure) return "";
    const size = ({ solver }) => ({ nx: solver.rectangles[0], ny: solver.rectangles[1] });
    if (fine) return `${say("patch.fine", { ...size(fine), count: fine.grids.length })} ${inWords(fine.status, "", this.app.units())}`;
    if (!coarse) return say("state.computing");
    return say(this.app.patches.isMoving ? "patch.moving" : "patch.coarse", size(coarse));
  }

  announce(result, units) {
    this.told = result;
    const text = (key) => units.figure(figureIn("patch", key), result.patch[key]);
    const peak = text("peak_pressure");
    this.heard.textContent = say("patch.live", { length: text("length"), width: text("width"), peak });
  }

  sentence(failure) {
    const units = this.app.units();
    const details = (failure.details ?? []).map(({ path, message }) => ({ path, message: inWords(message, path, units) }));
    return sentencesOf({ message: failure.message, details }).join(" ");
  }

  /** The inputs, anew where their kinds changed. */
  build(patch) {
    const { view } = this.app.store.state;
    const shapes = SIDES.map((side) => [shapeAcross(patch, side), patch[side].face !== undefined]);
    const key = JSON.stringify([patchPress(patch), patchDrive(patch, false), patchDrive(patch, true), shapes, patch.tolerance, view.system]);
    if (key === this.key) return;
    this.key = key;
    const focused = document.activeElement?.id;
    const { nodes, controls } = patchInputs(this.app, () => this.shown?.result);
    this.controls = controls;
    this.inputs.replaceChildren(...nodes);
    if (focused) document.getElementById(focused)?.focus();
  }

  draw(units) {
    const { result, coarse, isFine, tree } = this.shown;
    const palette = this.app.palette();
    const { friction } = tree.nip;
    for (const name of OF_FRICTION) this.maps.querySelector(`#patch-${name}`).hidden = friction === 0;
    const key = JSON.stringify([units.system, palette.name]);
    if (this.drawn?.result === result && this.drawn.key === key) return;
    this.drawn = { result, key };
    for (const [name, mapOf] of Object.entries(MAPS))
      if (friction > 0 || !OF_FRICTION.includes(name)) this.charts[name].show(mapOf(result, units, palette));
    this.notes.replaceChildren(...sentenceItems(result.warnings, units));
    this.table.replaceChildren(figuresTable(result, isFine ? coarse : null, friction, units));
  }

  /** Whether what is drawn is not the exact answer to the design at hand. */
  isOld() {
    const { case: tree, patch } = this.app.store.state;
    return !patch || !this.app.patches.of(tree, patch).fine;
  }

  figure(_snapshot, palette) {
    return this.shown ? MAPS[this.saving ?? "pressure"](this.shown.result, this.app.units(), palette) : null;
  }

  csvRows() {
    return patchColumns(this.shown.result, this.app.units());
  }

  save(name, format) {
    this.saving = name;
    return this.app.exportChart(format);
  }

  /** The case file for `rollnip patch solve`. */
  saveCase() {
    const { case: tree, patch } = this.app.store.state;
    const text = JSON.stringify(patchCase(tree, patch), null, 1);
    download(fileName(tree, "patch.json"), text, "application/json");
  }
}

/** The figures with their errors, and beside them those of the coarse grid. */
function figuresTable(result, coarse, friction, units) {
  const rows = patchRows(result, friction);
  const first = coarse ? Object.fromEntries(patchRows(coarse, friction).map((row) => [row.key, row])) : null;
  const head = [say("patch.figure"), say("patch.value"), say("patch.error"), ...(first ? [say("patch.on-coarse", { nx: coarse.solver.rectangles[0], ny: coarse.solver.rectangles[1] })] : [])];
  const cell = (value, dimension) => (value === null || value === undefined ? "–" : units.text(value, dimension));
  return el(
    "table",
    { class: "compare", id: "patch-table" },
    el("thead", {}, el("tr", {}, ...head.map((text) => el("th", { scope: "col", text })))),
    el(
      "tbody",
      {},
      ...rows.map(({ key, label, value, error, dimension }) =>
        el(
          "tr",
          { "data-patch": key },
          el("th", { scope: "row", text: label }),
          el("td", { text: cell(value, dimension) }),
          el("td", { class: "error", text: error === null ? say("patch.no-error") : `± ${units.error(error, dimension)}` }),
          first ? el("td", { text: cell(cleaned(first[key]?.value, value, error), dimension) }) : null,
        ),
      ),
    ),
  );
}

/** The value on a coarse grid; zero where the fine one is, and nothing but its error is left. */
function cleaned(first, value, error) {
  return value === 0 && error !== null && Math.abs(first) <= error ? 0 : first;
}
