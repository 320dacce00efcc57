// The other way round: which value of an input gives a wanted answer?

import { complaintOf, isAbort, post } from "./api.js";
import { button, el, select } from "./dom.js";
import { questionOf } from "./control.js";
import { getAt, same, setAt } from "./paths.js";
import { flat, inputsOf } from "./quantities.js";
import { RangeBoxes } from "./ranges.js";
import { typable } from "./units.js";
import { answersOf } from "./whatif.js";
import { inText, say } from "./texts.js";

const CHANGED = say("find.changed");
const SPAN = 30; // the search reaches from a thirtieth to thirty times the present value

/** The view say("find.go"). */
export class FindView {
  constructor(app) {
    this.id = "find";
    this.title = say("tab.find");
    this.app = app;
    this.told = null; // {tree, input} of the question that was answered
    this.asks = el("form", { class: "ask", "aria-label": say("tab.find") });
    this.asks.addEventListener("submit", (event) => {
      event.preventDefault();
      this.search();
    });
    this.said = el("div", { role: "status", id: "find-said" });
    this.within = new RangeBoxes("find", app, (path, ends) => {
      const { find } = app.store.state.view;
      app.store.view({ find: { ...find, ranges: { ...find.ranges, [path]: ends } } });
    });
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
    const { low, high } = this.range(this.input, tree);
    this.within.show(this.input, [low, high]);
    if (this.told && !this.isTold(tree)) this.said.replaceChildren();
  }

  /** Whether what was found is about this design, whatever its own value is. */
  isTold(tree) {
    const { path } = this.told.input;
    return same(setAt(tree, path, null), setAt(this.told.tree, path, null));
  }

  build(inputs, answers, result) {
    const units = this.app.units();
    const put = (change) => this.app.store.view({ find: { ...this.app.store.state.view.find, ...change } });
    const focused = document.activeElement?.id;
    const now = flat(result)[this.asked.key];
    this.wanted = el("input", {
      type: "text",
      id: "find-wanted",
      autocomplete: "off",
      value: now === undefined || now === null ? "" : typable(units.shown(now, this.asked.dimension), 3),
    });
    const unit = units.name(this.asked.dimension);
    this.asks.replaceChildren(
      select({
        id: "find-path",
        label: say("find.which"),
        options: inputs.map((one) => [one.path, one.label]),
        value: this.input.path,
        act: (value) => put({ path: value }),
      }),
      select({
        id: "find-answer",
        label: say("find.gives"),
        options: answers.map((one) => [one.key, one.label]),
        value: this.asked.key,
        act: (value) => put({ answer: value }),
      }),
      el(
        "div",
        { class: "field" },
        el("label", { for: "find-wanted", text: say("find.of") + (unit ? ` [${unit}]` : "") }),
        this.wanted,
      ),
      ...this.within.nodes,
      el("button", { type: "submit", class: "button main", id: "find-go", text: say("find.go") }),
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
    this.said.replaceChildren(el("p", { class: "hint", text: say("find.busy") }));
    try {
      const wanted = await this.read(abort.signal);
      await this.within.read;
      if (this.within.wrong.textContent) throw new Error(this.within.wrong.textContent);
      const found = await post(
        "/api/find",
        {
          case: tree,
          path: input.path,
          quantity: asked.key.replace("dissipation_", "dissipation."),
          wanted,
          ...this.range(input, tree),
        },
        abort.signal,
      );
      this.told = { tree, input };
      if (!this.isTold(this.app.store.state.case)) throw new Error(CHANGED);
      this.tell(found, wanted, input, asked);
    } catch (error) {
      if (!isAbort(error))
        this.said.replaceChildren(el("div", { class: "found not" }, el("p", { text: complaintOf(error) })));
    }
  }

  /** Where the value is sought: as typed, else far around the present one. */
  range(input, tree) {
    const typed = this.app.store.state.view.find.ranges?.[input.path];
    return typed ? { low: typed[0], high: typed[1] } : range(input, getAt(tree, input.path));
  }

  /** What is wanted, in the base unit; a plain number is in the unit beside the box. */
  async read(signal) {
    const text = this.wanted.value.trim();
    const bare = /^[+\-\u2212]?[0-9.,]+(e[+-]?\d+)?$/i.test(text);
    const { dimension } = this.asked;
    const units = this.app.units();
    const { name } = units.of(dimension);
    const isRead = units.isRead(dimension);
    if (!isRead && !bare) throw new Error(say("find.plain", { unit: name }));
    const question = isRead ? questionOf(text, dimension, units) : { text, dimension: "ratio" };
    const { value } = await post("/api/quantity", question, signal);
    return isRead ? value : units.base(value, dimension);
  }

  /** Take what was found into the design, where that is still what it was found for. */
  use(value) {
    const { case: tree } = this.app.store.state;
    if (!this.isTold(tree)) return this.app.say(CHANGED);
    return this.app.store.design({ case: setAt(tree, this.told.input.path, value) });
  }

  tell(found, wanted, input, asked) {
    const units = this.app.units();
    if (!found.found) {
      const text = outOfReach(found, input, asked, units) ?? found.message;
      this.said.replaceChildren(el("div", { class: "found not" }, el("p", { text })));
      return;
    }
    const place = (value) => units.text(value * input.factor, input.dimension);
    const others = found.others.length ? say("find.others", { others: found.others.map(place).join(say("find.and")) }) : "";
    this.said.replaceChildren(
      el(
        "div",
        { class: "found" },
        el("b", { text: `${input.label}: ${place(found.value)}` }),
        el("p", {
          text: say("find.found", {
            answer: inText(asked.label),
            value: units.text(found.result[asked.key] ?? wanted, asked.dimension),
          }) + others,
        }),
        button(say("find.use"), () => this.use(found.value), { kind: "main", id: "find-use" }),
      ),
    );
  }
}

/** That no value of the range is enough, in the units shown; null where that is not what is wrong. */
function outOfReach({ points, wanted }, input, asked, units) {
  const solved = points.map(([, y]) => y).filter((y) => y !== null);
  const [least, most] = [Math.min(...solved), Math.max(...solved)];
  if (solved.length === 0 || (wanted >= least && wanted <= most)) return null;
  const [from, to] = [points[0][0], points[points.length - 1][0]].map((x) =>
    units.text(x * input.factor, input.dimension),
  );
  const [low, high, aim] = [least, most, wanted].map((y) => units.text(y, asked.dimension));
  if (low === high)
    return say("find.flat", { input: input.label, from, to, answer: inText(asked.label), low });
  const lost = points.length - solved.length;
  const unsolved = lost ? say("find.unsolved", { lost, count: points.length }) : "";
  return say("find.out", { input: input.label, from, to, answer: inText(asked.label), aim, low, high }) + unsolved;
}

function range({ low, high, log, factor }, now) {
  if (log) return { low: now / SPAN, high: now * SPAN };
  return { low: Math.min(low / factor, now), high: Math.max(high / factor, now) };
}
