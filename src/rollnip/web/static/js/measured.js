// "I measured ...": the modulus of a covering from a nip width or an approach that was measured.

import { complaintOf, isAbort, post } from "./api.js";
import { questionOf } from "./control.js";
import { button, el, select } from "./dom.js";
import { kindOf } from "./design.js";
import { rangeText } from "./known.js";
import { getAt, setAt } from "./paths.js";
import { inWords } from "./said.js";
import { say } from "./texts.js";
import { typable } from "./units.js";

const SPAN = 30; // the modulus is sought from a thirtieth to thirty times the present one
const READING = 0.05; // of a nip width read off an ink print
const FIGURES = { nip_width: "measured.width", approach: "measured.approach" };

/** The view "I measured". */
export class MeasuredView {
  constructor(app) {
    this.id = "measured";
    this.title = say("measured.tab");
    this.app = app;
    this.asks = el("form", { class: "ask", "aria-label": this.title });
    this.asks.addEventListener("submit", (event) => {
      event.preventDefault();
      this.search();
    });
    this.said = el("div", { role: "status", id: "measured-said" });
    const hint = el("p", { class: "hint", text: say("measured.hint") });
    this.node = el("div", {}, hint, this.asks, this.said);
  }

  show({ tree, result, state }) {
    if (state === "preview") return;
    const places = coverings(tree);
    const figures = Object.keys(FIGURES).filter((key) => key !== "approach" || tree.nip.approach === undefined);
    const key = JSON.stringify([places.map(([path]) => path), figures, this.app.units().system]);
    if (key !== this.key) this.build(places, figures, result);
    this.key = key;
    if (this.told && this.told.tree !== tree) this.said.replaceChildren();
  }

  build(places, figures, result) {
    this.said.replaceChildren();
    if (places.length === 0) {
      this.asks.replaceChildren(el("p", { class: "empty", text: say("measured.none") }));
      return;
    }
    const units = this.app.units();
    const unit = units.name("length");
    const box = (id, text, value) => {
      const input = el("input", { type: "text", id, autocomplete: "off", value });
      return el("div", { class: "field" }, el("label", { for: id, text: `${text} [${unit}]` }), input);
    };
    const now = typable(units.shown(result.nip_width, "length"), 3);
    const reading = typable(units.shown(READING * result.nip_width, "length"), 2);
    this.asks.replaceChildren(
      select({
        id: "measured-figure",
        label: say("measured.what"),
        options: figures.map((key) => [key, say(FIGURES[key])]),
        value: figures[0],
        act: () => {},
      }),
      box("measured-value", say("measured.value"), now),
      box("measured-reading", say("measured.reading"), reading),
      select({
        id: "measured-place",
        label: say("measured.where"),
        options: places,
        value: places[0][0],
        act: () => {},
      }),
      el("button", { type: "submit", class: "button main", id: "measured-go", text: say("measured.go") }),
    );
  }

  async search() {
    const { tree } = this.app.last();
    this.abort?.abort();
    const abort = new AbortController();
    this.abort = abort;
    const ask = (id) => document.getElementById(id).value;
    const [quantity, path] = [ask("measured-figure"), ask("measured-place")];
    this.said.replaceChildren(el("p", { class: "hint", text: say("measured.busy") }));
    try {
      const value = await this.read(ask("measured-value"), abort.signal);
      const reading = await this.read(ask("measured-reading"), abort.signal);
      if (reading <= 0) throw new Error(say("measured.positive"));
      const start = this.start(tree, path);
      const found = [];
      for (const wanted of [value, value - reading, value + reading])
        found.push(await this.find(start, path, quantity, wanted, abort.signal));
      this.told = { tree, path };
      this.tell(found);
    } catch (error) {
      if (isAbort(error)) return;
      const text = inWords(complaintOf(error), path, this.app.units());
      this.said.replaceChildren(el("div", { class: "found not" }, el("p", { text })));
    }
  }

  async read(text, signal) {
    const question = questionOf(text.trim(), "length", this.app.units());
    return (await post("/api/quantity", question, signal)).value;
  }

  /** The case with the modulus of the covering as a number, to begin from. */
  start(tree, path) {
    const material = getAt(tree, path);
    if (kindOf(material) !== "shore") return tree;
    const { shore_a: shore, ...rest } = material;
    return setAt(tree, path, { ...rest, modulus: this.app.modulusOf(shore) });
  }

  async find(tree, path, quantity, wanted, signal) {
    const modulus = getAt(tree, `${path}.modulus`);
    const range = { low: modulus / SPAN, high: modulus * SPAN };
    const body = { case: tree, path: `${path}.modulus`, quantity, wanted, ...range };
    const found = await post("/api/find", body, signal);
    if (found.found) return found.value;
    throw new Error(say("measured.lost", { wanted: this.app.units().text(wanted, "length") }));
  }

  tell([modulus, ...ends]) {
    const units = this.app.units();
    const band = [Math.min(...ends), Math.max(...ends)];
    const text = say("measured.found", {
      modulus: units.text(modulus, "pressure", 3),
      band: rangeText(band, "pressure", units),
    });
    this.said.replaceChildren(
      el(
        "div",
        { class: "found" },
        el("b", { text }),
        el("p", { text: say("measured.note") }),
        button(say("measured.use"), () => this.use(modulus, band), { kind: "main", id: "measured-use" }),
      ),
    );
  }

  /** Take the modulus and its band into the design it was found for. */
  use(modulus, band) {
    const { store } = this.app;
    const { case: tree, view } = store.state;
    const { path } = this.told;
    if (tree !== this.told.tree) return this.app.say(say("measured.changed"));
    const { shore_a: _shore, ...rest } = getAt(tree, path);
    const exact = Number(modulus.toPrecision(5));
    const measured = { ...view.measured, [path]: { modulus: exact, band } };
    store.state = { ...store.state, view: { ...view, measured } };
    return store.design({ case: setAt(tree, path, { ...rest, modulus: exact }) });
  }
}

/** Coverings whose modulus can be measured so: elastic ones, as [path, name]. */
function coverings(tree) {
  return ["upper", "lower"].flatMap((side) =>
    tree[side].layers.flatMap(({ material }, i) => {
      const isElastic = material.model === "elastic" && material.shear_modulus === undefined;
      const name = say(`measured.${side}`, { number: i + 1 });
      return isElastic ? [[`${side}.layers[${i}].material`, name]] : [];
    }),
  );
}

/** What was measured of a design as the server takes it, where the modulus is still that one. */
export function measuredIn(tree, measured) {
  const entries = Object.entries(measured).filter(
    ([path, one]) => one && getAt(tree, `${path}.modulus`) === one.modulus,
  );
  return Object.fromEntries(entries.map(([path, { band }]) => [path, band]));
}
