// What happens to an answer when one input changes: a curve.

import { isAbort, post } from "./api.js";
import { Chart, layoutOf, line, titled } from "./charts.js";
import { button, el, select } from "./dom.js";
import { getAt } from "./paths.js";
import { ANSWERS, flat, inputsOf } from "./quantities.js";

const POINTS = 19;
const COARSE = 3;
const TURN = 2.5; // a value on a logarithmic slider is varied by this factor either way

/** The answers that can be plotted or sought for a result. */
export function answersOf(result) {
  const all = flat(result);
  return ANSWERS.filter(({ key }) => all[key] !== null && all[key] !== undefined);
}

/** The view "What if". */
export class WhatIfView {
  constructor(app) {
    this.id = "whatif";
    this.title = "What if";
    this.app = app;
    const place = el("div", { class: "chart", id: "chart-whatif" });
    this.chart = new Chart(place);
    this.asks = el("div", { class: "ask" });
    this.said = el("p", { class: "hint", id: "whatif-said" });
    const exports = ["PNG", "SVG", "CSV"].map((format) =>
      button(format, () => app.exportChart(format), {
        kind: "small",
        id: `whatif-${format.toLowerCase()}`,
        label: `Save this chart as ${format}`,
      }),
    );
    this.node = el(
      "div",
      {},
      this.asks,
      place,
      el("div", { class: "chart-foot" }, this.said, el("div", { class: "row" }, ...exports)),
    );
  }

  async show({ tree, result, state }) {
    if (state === "preview") return;
    const inputs = inputsOf(tree);
    const answers = answersOf(result);
    const { path, answer } = this.app.store.state.view.whatif;
    const input = inputs.find((one) => one.path === path) ?? inputs[0];
    const asked = answers.find(({ key }) => key === answer) ?? answers[0];
    this.choose(inputs, answers, input, asked);
    const values = valuesOf(input, getAt(tree, input.path));
    const key = JSON.stringify([tree, input.path, values]);
    const now = { value: getAt(tree, input.path), result: flat(result) };
    this.asking = { key, input, asked, now };
    if (this.sweep?.key === key) this.draw();
    else {
      if (!this.shown) this.begin(values);
      await this.fetch(key, tree, input.path, values);
    }
  }

  /** Axes and the dot of the design, while there is no curve yet. */
  begin(values) {
    const ends = [values[0], values[values.length - 1]];
    const sweep = { key: null, values: ends, results: ends.map(() => ({ converged: false })) };
    this.shown = { ...this.asking, sweep };
    this.chart.show(curve(this.shown, this.app.units(), this.app.palette()));
  }

  /** Whether what is drawn is still of an older question. */
  isOld() {
    return this.sweep?.key !== this.asking?.key || this.sweep.values.length < POINTS;
  }

  choose(inputs, answers, input, asked) {
    const key = JSON.stringify([
      inputs.map((one) => one.path),
      answers.map((one) => one.key),
      input.path,
      asked.key,
    ]);
    if (key === this.chosenKey) return;
    this.chosenKey = key;
    const put = (change) =>
      this.app.store.view({ whatif: { ...this.app.store.state.view.whatif, ...change } });
    const focused = document.activeElement?.id;
    this.asks.replaceChildren(
      select({
        id: "whatif-answer",
        label: "How does",
        options: answers.map((one) => [one.key, one.label]),
        value: asked.key,
        act: (value) => put({ answer: value }),
      }),
      select({
        id: "whatif-path",
        label: "change with",
        options: inputs.map((one) => [one.path, one.label]),
        value: input.path,
        act: (value) => put({ path: value }),
      }),
    );
    if (focused) document.getElementById(focused)?.focus();
  }

  /** Every third value first, so that a curve is soon there; then the others. */
  async fetch(key, tree, path, values) {
    this.abort?.abort();
    const abort = new AbortController();
    this.abort = abort;
    this.said.textContent = "Computing …";
    this.chart.node.classList.add("old");
    const found = new Map();
    const isFirst = (i) => i % COARSE === 0;
    try {
      for (const wanted of [isFirst, (i) => !isFirst(i)]) {
        const part = values.filter((_value, i) => wanted(i));
        const answer = await post("/api/sweep", { case: tree, path, values: part }, abort.signal);
        part.forEach((value, i) => found.set(value, answer.results[i]));
        const there = values.filter((value) => found.has(value));
        this.sweep = { key, values: there, results: there.map((value) => found.get(value)) };
        this.draw();
      }
    } catch (error) {
      if (!isAbort(error)) this.said.textContent = error.message;
    }
  }

  draw() {
    if (this.sweep.key !== this.asking.key) return;
    const { results } = this.sweep;
    const lost = results.filter((one) => !isSound(one)).length;
    if (results.length < POINTS) this.said.textContent = "Computing …";
    else
      this.said.textContent = lost
        ? `${lost} of ${results.length} values have no sound answer and are left out.`
        : "The dot is your design; each point of the curve is a full solution.";
    this.chart.node.classList.remove("old");
    this.shown = { ...this.asking, sweep: this.sweep };
    this.chart.show(curve(this.shown, this.app.units(), this.app.palette()));
  }

  figure(_snapshot, palette) {
    return this.shown ? curve(this.shown, this.app.units(), palette) : null;
  }
}

function isSound(one) {
  return !one.error && one.converged !== false;
}

/** Values of a sweep around the present one, without what no slider could reach. */
function valuesOf({ low, high, log, factor }, now) {
  const [first, last] = log
    ? [(now * factor) / TURN, now * factor * TURN]
    : [Math.min(low, now * factor), Math.max(high, now * factor)];
  const at = (i) =>
    log ? first * (last / first) ** (i / (POINTS - 1)) : first + ((last - first) * i) / (POINTS - 1);
  return Array.from({ length: POINTS }, (_none, i) => Number((at(i) / factor).toPrecision(8)));
}

function curve({ sweep, input, asked, now }, units, palette) {
  const { dimension, factor, label } = input;
  const x = sweep.values.map((value) => units.shown(value * factor, dimension));
  const y = units.list(
    sweep.results.map((one) => (isSound(one) ? one[asked.key] : null)),
    asked.dimension,
  );
  const unit = units.name(asked.dimension);
  const own = units.name(dimension);
  const hover = `%{x:.4~g} ${own}: %{y:.4~g} ${unit}<extra></extra>`;
  const data = [
    line(asked.label, x, y, palette.pressure, {
      mode: "lines+markers",
      marker: { size: 5 },
      hovertemplate: hover,
      showlegend: false,
    }),
    {
      type: "scatter",
      mode: "markers",
      name: "your design",
      x: [units.shown(now.value * factor, dimension)],
      y: units.list([now.result[asked.key]], asked.dimension),
      marker: { size: 13, color: palette.shear, line: { color: palette.ground, width: 2 } },
      hovertemplate: hover,
      showlegend: false,
    },
  ];
  const layout = layoutOf(palette, titled(label, own), titled(asked.label, unit), { hovermode: "closest" });
  return { data, layout, label: `${asked.label} over ${label}.` };
}
