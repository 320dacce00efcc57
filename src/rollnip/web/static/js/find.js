// The other way round: which value of an input gives a wanted answer?

import { complaintOf, isAbort, post } from "./api.js";
import { button, el, select } from "./dom.js";
import { getAt, setAt } from "./paths.js";
import { inputsOf } from "./quantities.js";
import { number } from "./units.js";
import { answersOf } from "./whatif.js";

const SPAN = 30; // the search reaches from a thirtieth to thirty times the present value

/** The view "Find". */
export class FindView {
  constructor(app) {
    this.id = "find";
    this.title = "Find a value";
    this.app = app;
    this.asks = el("form", { class: "ask", "aria-label": "Find a value" });
    this.asks.addEventListener("submit", (event) => {
      event.preventDefault();
      this.search();
    });
    this.said = el("div", { role: "status", id: "find-said" });
    this.node = el("div", {}, this.asks, this.said);
  }

  show({ tree, result, state }) {
    if (state === "preview") return;
    const inputs = inputsOf(tree);
    const answers = answersOf(result).filter(({ key }) => key !== "load");
    const { path, answer } = this.app.store.state.view.find;
    this.input = inputs.find((one) => one.path === path) ?? inputs[0];
    this.asked = answers.find(({ key }) => key === answer) ?? answers[0];
    const key = JSON.stringify([
      inputs.map((one) => one.path),
      answers.map((one) => one.key),
      this.input.path,
      this.asked.key,
      this.app.units().system,
    ]);
    if (key !== this.key) this.build(inputs, answers, result);
    this.key = key;
  }

  build(inputs, answers, result) {
    const units = this.app.units();
    const put = (change) => this.app.store.view({ find: { ...this.app.store.state.view.find, ...change } });
    const focused = document.activeElement?.id;
    const now = result[this.asked.key];
    this.wanted = el("input", {
      type: "text",
      id: "find-wanted",
      autocomplete: "off",
      value: now === undefined || now === null ? "" : number(units.shown(now, this.asked.dimension), 3),
    });
    const unit = units.name(this.asked.dimension);
    this.asks.replaceChildren(
      select({
        id: "find-path",
        label: "Which value of",
        options: inputs.map((one) => [one.path, one.label]),
        value: this.input.path,
        act: (value) => put({ path: value }),
      }),
      select({
        id: "find-answer",
        label: "gives",
        options: answers.map((one) => [one.key, one.label]),
        value: this.asked.key,
        act: (value) => put({ answer: value }),
      }),
      el(
        "div",
        { class: "field" },
        el("label", { for: "find-wanted", text: unit ? `of [${unit}]` : "of" }),
        this.wanted,
      ),
      el("button", { type: "submit", class: "button main", id: "find-go", text: "Find" }),
    );
    this.said.replaceChildren();
    if (focused) document.getElementById(focused)?.focus();
  }

  async search() {
    const { tree } = this.app.last();
    const { input, asked } = this;
    this.abort?.abort();
    const abort = new AbortController();
    this.abort = abort;
    this.said.replaceChildren(el("p", { class: "hint", text: "Searching …" }));
    try {
      const wanted = await this.read();
      const found = await post(
        "/api/find",
        {
          case: tree,
          path: input.path,
          quantity: asked.key,
          wanted,
          ...range(input, getAt(tree, input.path)),
        },
        abort.signal,
      );
      this.tell(found, wanted, input, asked);
    } catch (error) {
      if (!isAbort(error))
        this.said.replaceChildren(el("div", { class: "found not" }, el("p", { text: complaintOf(error) })));
    }
  }

  /** What is wanted, in the base unit; a plain number is in the unit beside the box. */
  async read() {
    const text = this.wanted.value.trim();
    const bare = /^[+\-\u2212]?[0-9.,]+(e[+-]?\d+)?$/i.test(text);
    const { dimension } = this.asked;
    const unit = bare ? this.app.units().of(dimension).name : "";
    const { value } = await post("/api/quantity", {
      text: unit ? `${text} ${unit}` : text,
      dimension: dimension === "share" ? "ratio" : dimension,
    });
    return value;
  }

  tell(found, wanted, input, asked) {
    const units = this.app.units();
    if (!found.found) {
      this.said.replaceChildren(el("div", { class: "found not" }, el("p", { text: found.message })));
      return;
    }
    const value = units.text(found.value * input.factor, input.dimension);
    const use = () =>
      this.app.store.design({ case: setAt(this.app.store.state.case, input.path, found.value) });
    this.said.replaceChildren(
      el(
        "div",
        { class: "found" },
        el("b", { text: `${input.label}: ${value}` }),
        el("p", {
          text: `gives ${asked.label.toLowerCase()} ${units.text(found.result[asked.key] ?? wanted, asked.dimension)}.`,
        }),
        button("Use this value", use, { kind: "main", id: "find-use" }),
      ),
    );
  }
}

function range({ low, high, log, factor }, now) {
  if (log) return { low: now / SPAN, high: now * SPAN };
  return { low: Math.min(low / factor, now), high: Math.max(high / factor, now) };
}
