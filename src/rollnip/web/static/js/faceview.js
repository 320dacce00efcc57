// Along the face: sliders for crown and load, the bent rollers, the print of the nip, curves, figures.

import { foreignHint, sentenceItems } from "./answers.js";
import { isAbort, post } from "./api.js";
import { Chart, layoutOf, line, titled } from "./charts.js";
import { Control } from "./control.js";
import { button, el, select, withUnit } from "./dom.js";
import { SIDES, withFace } from "./face.js";
import { bentPicture, printPicture } from "./facedrawing.js";
import { ImpressionPart } from "./impression.js";
import { getAt, same, setAt } from "./paths.js";
import { complaintsOf, refused } from "./places.js";
import { PressControl, pressKind } from "./press.js";
import { figureIn } from "./quantities.js";
import { say } from "./texts.js";
import { number } from "./units.js";

const COLOURS = {
  load: "pressure",
  peak_pressure: "pressure",
  nip_width: "upper",
  traction: "shear",
  feed_upper: "upper",
  feed_lower: "upper",
  tension_in: "shear",
};
const CURVES = ["load", "peak_pressure", "nip_width", "traction"];
const SHEET_CURVES = ["feed_upper", "feed_lower", "tension_in"];
const ROWS = ["mean_load", "total_load", "evenness", "even_share", "largest_scrub", "added_length"];
const SHEET_ROWS = ["mean_feed", "feed_difference", "least_tension_in", "taut_tension"];
const OF_POWERS = ["torque", "loss"]; // errors of figures that may be next to nothing; not verified
const NOISE = 1e-9; // of the mean load: a traction below it is rounding
const WITHIN = 0.1;
const FIELDS = [
  [/\.shaft\.crown$/, ".shaft.crown.height"],
  [/^face\.end_loads$/, "face.end_loads[0]"],
];

/** How the face of a design is asked for. */
export const FACE_ROUTE = {
  path: "/api/face",
  tab: "face",
  isWanted: (tree) => Boolean(tree.face),
  fieldOf: (path) => FIELDS.reduce((text, [found, field]) => text.replace(found, field), path),
};

/** A second control of a value that has one among the inputs. */
class LiveControl extends Control {
  get id() {
    return `face-${super.id}`;
  }
}

class LiveForce extends PressControl {
  get id() {
    return `face-${super.id}`;
  }
}

/** The view "Along the face". */
export class FaceView {
  constructor(app) {
    this.id = "face";
    this.title = say("face.title");
    this.app = app;
    this.controls = [];
    const start = () => app.store.design({ case: withFace(app.store.state.case, app.store.state.view.system) });
    this.none = el(
      "div",
      { class: "empty" },
      el("p", { text: say("face.none") }),
      button(say("face.give"), start, { kind: "main", id: "give-face" }),
    );
    this.sliders = el("div", { class: "face-sliders" });
    this.said = el("p", { class: "wrong", id: "face-said", role: "status" });
    this.busy = el("p", { class: "hint", text: say("state.computing") });
    this.bent = el("div");
    this.print = el("div");
    this.bentText = el("figcaption");
    this.printText = el("figcaption");
    this.pictures = el(
      "div",
      { class: "face-pictures" },
      el("figure", { id: "face-bent" }, this.bent, this.bentText),
      el("figure", { id: "face-print" }, this.print, this.printText),
    );
    this.chart = new Chart(el("div", { class: "chart low", id: "chart-face" }));
    this.figures = el("div", { class: "figures", id: "face-figures" });
    this.notes = el("ul", { class: "warnings", id: "face-notes" });
    this.english = el("p", { class: "hint", id: "face-english" });
    this.asks = el("div", { class: "ask" });
    this.found = el("div", { role: "status", id: "crown-said" });
    const exports = ["PNG", "SVG", "CSV"].map((format) =>
      button(format, () => app.exportChart(format), {
        kind: "small",
        id: `face-${format.toLowerCase()}`,
        label: say("chart.save", { format }),
      }),
    );
    this.foot = el("div", { class: "chart-foot" }, el("p", { class: "hint", text: say("face.foot") }), el("div", { class: "row" }, ...exports));
    this.impression = new ImpressionPart(app);
    this.whole = el("div", { class: "face" }, this.sliders, this.said, this.busy, this.pictures, this.notes, this.english, this.asks, this.chart.node, this.foot, this.figures, this.found, this.impression.node);
    this.node = el("div", {}, this.none, this.whole);
    new ResizeObserver(() => this.drawn && this.draw(this.drawn.tree, this.drawn.face)).observe(this.pictures);
  }

  /** Called with every answer; the face of a design comes by itself. */
  show() {
    this.refresh();
  }

  /** Show the design at hand: its sliders, and its face where that is there. */
  refresh() {
    if (!this.node.isConnected) return;
    const { case: tree, view } = this.app.store.state;
    this.none.hidden = Boolean(tree.face);
    this.whole.hidden = !tree.face;
    if (!tree.face) return;
    this.build(tree, view);
    for (const control of this.controls) control.refresh(tree);
    this.impression.refresh(tree);
    const failure = this.app.faces.failureOf(tree);
    this.said.textContent = failure ? refused(failure, tree, this.app) : "";
    this.said.hidden = !failure;
    const face = this.app.faces.of(tree);
    this.busy.hidden = Boolean(face || failure);
    for (const node of [this.pictures, this.chart.node, this.foot, this.notes, this.english]) node.hidden = !face && !this.drawn;
    if (face) this.draw(tree, face);
    for (const node of [this.pictures, this.chart.node, this.figures]) node.classList.toggle("old", !face);
    if (this.advice && !same(this.advice.tree, tree)) this.found.replaceChildren();
  }

  /** Sliders and questions, anew where the shape of the design changed. */
  build(tree, view) {
    const crowned = SIDES.filter((side) => typeof getAt(tree, `${side}.shaft.crown.height`) === "number");
    const kind = pressKind(this.app);
    const key = JSON.stringify([crowned, kind, view.system, view.face, Boolean(tree.sheet)]);
    if (key === this.key) return;
    this.key = key;
    const focused = document.activeElement?.id;
    const crowns = crowned.map((side) => new LiveControl(`${side}.shaft.crown.height`, this.app, say(`face.crown-${side}`)));
    this.controls = [...crowns, ...this.loads(kind)];
    this.sliders.replaceChildren(...this.controls.map(({ node }) => node));
    const put = (change) => this.app.store.view({ face: { ...this.app.store.state.view.face, ...change } });
    const rollers = SIDES.filter((side) => tree[side].shaft);
    this.asks.replaceChildren(
      select({
        id: "face-curve",
        label: say("face.show"),
        options: curvesIn(tree).map((name) => [name, figureIn("curve", name).label]),
        value: curveIn(tree, view.face.curve),
        act: (curve) => put({ curve }),
      }),
      ...(rollers.length === 0 || kind === "approach"
        ? []
        : [
            select({
              id: "crown-roller",
              label: say("crown.of"),
              options: rollers.map((side) => [side, say(`roller.${side}`)]),
              value: rollers.includes(view.face.roller) ? view.face.roller : rollers[0],
              act: (roller) => put({ roller }),
            }),
            button(say("crown.go"), () => this.search(), { kind: "main", id: "crown-go" }),
          ]),
    );
    if (focused) document.getElementById(focused)?.focus();
  }

  loads(kind) {
    if (kind === "arms") return [0, 1].map((end) => new LiveControl(`face.arms[${end}].bearing_lever`, this.app, say(`face.arm-lever-${end}`)));
    if (kind === "force" || kind === "cylinders") return [new LiveForce("force", this.app)];
    const paths = kind === "ends" ? ["face.end_loads[0]", "face.end_loads[1]"] : [`nip.${kind}`];
    return paths.map((path) => new LiveControl(path, this.app));
  }

  draw(tree, face) {
    this.drawn = { tree, face };
    const look = { palette: this.app.palette(), units: this.app.units(), width: this.pictures.clientWidth || 600 };
    const bent = bentPicture(tree, face, look);
    const print = printPicture(face, look);
    this.bent.replaceChildren(bent.node);
    this.print.replaceChildren(print.node);
    const crossed = tree.face.skew === 0 ? "" : ` ${say("face.crossed")}`;
    this.bentText.textContent = say("face.bent", { times: number(bent.times) }) + crossed;
    this.printText.textContent = say("face.print", { times: number(print.times) });
    this.chart.show(faceChart(face, this.curve, look.units, look.palette));
    const notes = face.converged ? face.warnings : [face.status, ...face.warnings];
    this.notes.replaceChildren(...sentenceItems(notes, look.units));
    this.english.textContent = foreignHint(notes);
    this.figures.replaceChildren(...faceRows(face, look.units).map(figureOf));
  }

  get curve() {
    const { case: tree, view } = this.app.store.state;
    return curveIn(tree, view.face.curve);
  }

  /** Whether what is drawn is of another design. */
  isOld() {
    return !this.app.faces.of(this.app.store.state.case);
  }

  figure({ tree }, palette) {
    const face = this.app.faces.of(tree);
    return face ? faceChart(face, this.curve, this.app.units(), palette) : null;
  }

  csvRows() {
    return faceColumns(this.app.faces.of(this.app.store.state.case), this.app.units());
  }

  /** Ask which crown evens out the load. */
  async search() {
    const { case: tree, view } = this.app.store.state;
    const chosen = tree[view.face.roller]?.shaft ? view.face.roller : SIDES.find((side) => tree[side].shaft);
    this.asking?.abort();
    this.asking = new AbortController();
    this.advice = { tree };
    this.found.replaceChildren(el("p", { class: "hint", text: say("crown.busy") }));
    try {
      const body = { case: tree, roller: chosen, within: WITHIN };
      this.tell(tree, await post("/api/crown", body, this.asking.signal));
    } catch (error) {
      if (isAbort(error)) return;
      this.found.replaceChildren(el("div", { class: "found not" }, el("p", { text: complaintsOf(error, tree, this.app.units()).join(" ") })));
    }
  }

  tell(tree, best) {
    if (!same(tree, this.app.store.state.case)) return this.found.replaceChildren();
    const units = this.app.units();
    const text = (value, dimension) => units.text(value, dimension, 3);
    const use = () => {
      const { case: now } = this.app.store.state;
      const height = Number(best.height.toPrecision(3));
      const path = `${best.roller}.shaft.crown`;
      this.app.store.design({ case: setAt(now, path, { height, shape: "parabolic" }) });
    };
    const [low, high] = best.loads.map((value) => text(value, "line load"));
    const served = servedText(best, text);
    const skew = best.skew > 0 ? say("crown.skew", { skew: text(best.skew, "angle of axes") }) : "";
    return this.found.replaceChildren(
      el(
        "div",
        { class: "found" },
        el("b", { text: say(`crown.found-${best.roller}`, { height: text(best.height, "length") }) }),
        el("p", { text: `${say("crown.loads", { low, high })} ${served} ${skew}`.trim() }),
        button(say("crown.use"), use, { kind: "main", id: "crown-use" }),
      ),
    );
  }
}

/** The curves of a design: those of its sheet, too, where it has one. */
function curvesIn(tree) {
  return tree.sheet ? [...CURVES, ...SHEET_CURVES] : CURVES;
}

function curveIn(tree, wanted) {
  return curvesIn(tree).includes(wanted) ? wanted : CURVES[0];
}

function servedText({ served, low, high, within }, text) {
  const share = number(100 * within);
  if (!served) return say("crown.serves-none", { share });
  const ends = { low: low === null ? "" : text(low, "line load"), high: high === null ? "" : text(high, "line load"), share };
  if (low !== null && high !== null) return say("crown.serves", ends);
  if (low !== null) return say("crown.serves-above", ends);
  return high !== null ? say("crown.serves-below", ends) : say("crown.serves-all", ends);
}

/** A curve over the face. */
export function faceChart(face, curve, units, palette) {
  const key = face[curve] ? curve : CURVES[0];
  const { label: name, dimension } = figureIn("curve", key);
  const unit = units.name(dimension);
  const x = units.list(face.y, "length");
  const values = cleaned(face, key);
  const data = [line(name, x, units.list(values, dimension), palette[COLOURS[key]], { width: 2.6, hovertemplate: `%{y:.4~g} ${unit}` })];
  if (key === "load") {
    const mean = units.shown(face.mean_load, dimension);
    const style = { dash: "dot", width: 1.5, hoverinfo: "skip" };
    data.push(line(say("face.mean"), [x[0], x[x.length - 1]], [mean, mean], palette.bound, style));
  }
  const layout = layoutOf(palette, titled(say("axis.face"), units.name("length")), titled(name, unit), {
    along: units.name("length"),
    yaxis: ["traction", "feed_upper", "feed_lower", "tension_in"].includes(key) ? {} : { rangemode: "tozero" },
    showlegend: key === "load",
  });
  return { data, layout, label: say("face.chart", { name }) };
}

/** A list over y; a traction that is rounding beside the load is none. */
function cleaned(face, key) {
  const values = face[key];
  if (key !== "traction") return values;
  return values.map((value) => (Math.abs(value) < NOISE * face.mean_load ? 0 : value));
}

/** What is said of a face, as {key, label, text, unit, error, hint}. */
export function faceRows(face, units) {
  const worst = Math.max(...Object.entries(face.error).map(([key, error]) => (OF_POWERS.includes(key) ? 0 : error)));
  const row = (key) => {
    const { label, hint, dimension, digits } = figureIn("face", key);
    const value = key === "largest_scrub" ? cleanedScrub(face) : face[key];
    return { key, label, ...units.format(value, dimension, digits), hint };
  };
  const claimed = { key: "error", label: say("face.error"), ...units.format(worst, "share", 2), hint: say("face.error-hint") };
  return [...[...ROWS, ...SHEET_ROWS].filter((key) => Number.isFinite(face[key])).map(row), claimed];
}

function cleanedScrub({ largest_scrub: scrub, mean_load: mean }) {
  return scrub < NOISE * mean ? 0 : scrub;
}

function figureOf({ key, label, hint, ...shown }) {
  return el(
    "dl",
    { class: "figure" },
    el("dt", { text: label }),
    el("dd", { "data-face": key }, ...withUnit(shown)),
    el("dd", { class: "note", text: hint }),
  );
}

/** Everything over y as rows of a table, units in the head. */
export function faceColumns(face, units) {
  const columns = [
    "y",
    ...[...CURVES, ...SHEET_CURVES, ...SIDES.map((side) => `deflection_${side}`)],
  ].filter((key) => face[key]).map((key) => ({ ...figureIn("curve", key), list: cleaned(face, key) }));
  const head = columns.map(({ label, dimension }) => `${label} [${units.of(dimension).name}]`);
  const lists = columns.map(({ list, dimension }) => units.list(list, dimension));
  return [head, ...face.y.map((_y, i) => lists.map((list) => list[i]))];
}
