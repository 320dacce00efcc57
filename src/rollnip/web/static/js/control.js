// One number of a design: a slider and a text box that takes units.

import { complaintOf, post } from "./api.js";
import { el } from "./dom.js";
import { withSize } from "./design.js";
import { getAt, idOf } from "./paths.js";
import { inputAt } from "./quantities.js";
import { inWords } from "./said.js";
import { say } from "./texts.js";
import { askedAs, joined, typable } from "./units.js";

const STEPS = 500; // of a slider
const DIGITS = 3; // a slider gives round values in the unit shown
const BOX_DIGITS = 5;

/** A control of the number at `path`. `app` is {store, units()}. */
export class Control {
  constructor(path, app, label = null) {
    this.path = path;
    this.app = app;
    this.label = label; // another than that of the input
    this.sent = null;
    this.tried = null; // the text that was last sent to be read
    this.asked = 0; // how many texts were sent to be read
    this.isUnread = false; // the box holds what nobody can read
    this.node = this.build();
    this.refresh(app.store.state.case);
  }

  get input() {
    return inputAt(this.path, this.app.store.state.case);
  }

  /** Id of the box, and how those of its slider and notes begin. */
  get id() {
    return idOf(this.path);
  }

  build() {
    const { hint } = this.input;
    const label = this.label ?? this.input.label;
    const { id } = this;
    const described = `${id}-unit ${id}-wrong${hint ? ` ${id}-hint` : ""}`;
    this.box = el("input", {
      id,
      type: "text",
      inputmode: "text",
      autocomplete: "off",
      spellcheck: "false",
      "aria-describedby": described,
    });
    this.unit = el("span", { class: "unit", id: `${id}-unit` });
    this.slider = el("input", {
      id: `${id}-slider`,
      type: "range",
      min: 0,
      max: STEPS,
      step: 1,
      "aria-label": say("control.slider", { label }),
    });
    this.wrong = el("p", { class: "wrong", id: `${id}-wrong` });
    this.slider.addEventListener("input", () => this.slid());
    this.slider.addEventListener("pointerup", () => this.app.store.rest());
    this.box.addEventListener("change", () => this.typed());
    this.box.addEventListener("blur", () => this.left());
    this.box.addEventListener("keydown", (event) => this.key(event));
    return el(
      "div",
      { class: "control", "data-path": this.path },
      el("label", { for: id, text: label }),
      el("span", { class: "box" }, this.box, this.unit),
      this.slider,
      this.wrong,
      hint ? el("p", { class: "hint", id: `${id}-hint`, text: hint }) : null,
    );
  }

  /** Undo takes back what was typed; where nothing was, the last change of the design. */
  key(event) {
    const name = event.key.toLowerCase();
    if (!(event.ctrlKey || event.metaKey) || event.altKey || (name !== "z" && name !== "y")) return;
    event.preventDefault();
    event.stopPropagation();
    const { store } = this.app;
    if (this.box.value.trim() !== this.text) this.write();
    else if (name === "y" || event.shiftKey) store.redo();
    else store.undo();
  }

  /** What a browser put into the box without saying so is read, too. */
  left() {
    const text = this.box.value.trim();
    if (text !== this.text && text !== this.tried) this.typed();
  }

  /** Show the value of a design, in the unit now chosen. */
  refresh(tree) {
    const value = this.valueIn(tree);
    if (typeof value !== "number") return;
    const { dimension, factor, low, high } = this.input;
    const range = `${low} ${high}`;
    if (range !== this.range && value !== this.sent) this.slider.value = String(this.place(value));
    this.range = range;
    const units = this.app.units();
    const text = typable(units.shown(value * factor, dimension), BOX_DIGITS);
    const unit = units.name(dimension);
    const key = `${value} ${text} ${unit}`;
    if (key === this.shownKey && this.wrong.textContent === "") return;
    this.shownKey = key;
    this.text = text;
    this.unit.textContent = unit;
    this.slider.setAttribute("aria-valuetext", joined(text, unit));
    if (value !== this.sent) {
      this.sent = null;
      this.slider.value = String(this.place(value));
    }
    this.write();
  }

  /** The value of the design in the box, whatever was typed there. */
  write() {
    this.box.value = this.text;
    this.tried = null;
    this.isUnread = false;
    this.complain("");
    this.app.stand();
  }

  /** What the server says of the value; a text that cannot be read is worse, and stays said. */
  refuse(message) {
    if (this.isUnread) return;
    this.complain(message && inWords(message, this.path, this.app.units(), this.input));
  }

  /** Say what is wrong with the value; "" takes it back. */
  complain(message) {
    this.wrong.textContent = message;
    if (message) this.box.setAttribute("aria-invalid", "true");
    else this.box.removeAttribute("aria-invalid");
  }

  /** Where a value stands on the slider. */
  place(value) {
    const { low, high, log, factor } = this.input;
    const at = log
      ? Math.log((value * factor) / low) / Math.log(high / low)
      : (value * factor - low) / (high - low);
    return Math.round(STEPS * Math.min(1, Math.max(0, at)));
  }

  slid() {
    const { low, high, log, factor, dimension } = this.input;
    const at = Number(this.slider.value) / STEPS;
    const raw = log ? low * (high / low) ** at : low + at * (high - low);
    const units = this.app.units();
    const span = log ? 0 : units.shown(high, dimension) - units.shown(low, dimension);
    const round = rounded(units.shown(raw, dimension), span);
    this.set(units.base(round, dimension) / factor, this.path);
  }

  /** Read what was typed: a plain number is in the unit shown beside the box. */
  typed() {
    const text = this.box.value.trim();
    const turn = (this.asked += 1);
    if (text !== this.text) this.app.reads(this.read(text, turn));
    else if (this.isUnread) this.write();
  }

  /** Take what a text means, unless a later one was typed meanwhile or the value is another now. */
  async read(text, turn) {
    const { dimension, factor } = this.input;
    const before = this.value;
    const isLate = () => turn !== this.asked || this.value !== before;
    this.tried = text;
    try {
      const { value } = await post("/api/quantity", this.question(text, dimension));
      if (isLate()) return;
      this.set(value / factor, null);
      this.write();
    } catch (error) {
      if (isLate()) return;
      this.isUnread = true;
      this.complain(inWords(complaintOf(error), this.path, this.app.units()));
    }
  }

  /** The value of the design at hand; undefined where it has none any more. */
  get value() {
    return this.valueIn(this.app.store.state.case);
  }

  valueIn(tree) {
    return getAt(tree, this.path);
  }

  question(text, dimension) {
    return questionOf(text, dimension, this.app.units(), this.path.endsWith("shore_a"));
  }

  set(value, gesture) {
    this.sent = gesture === null ? null : value;
    this.app.store.design({ case: this.treeWith(value) }, gesture);
  }

  treeWith(value) {
    const { case: tree, view } = this.app.store.state;
    return withSize(tree, this.path, value, view.keeps);
  }
}

/** The question what a text means; a plain number is in the unit shown. */
export function questionOf(text, dimension, units, hardness = false) {
  const unit = units.of(dimension).name;
  return { text, dimension: askedAs(dimension), unit, hardness };
}

/** A value to three digits; on a linear scale to a round part of the `span`, and to zero beside it. */
function rounded(shown, span) {
  if (span === 0) return Number(shown.toPrecision(DIGITS));
  if (Math.abs(shown) < 1e-3 * span) return 0;
  const step = 10 ** Math.floor(Math.log10(span / STEPS) + 0.31);
  return Number((Math.round(shown / step) * step).toPrecision(12));
}
