// What happens to an answer when one input changes: a curve.

import { isAbort, post } from "./api.js";
import { Chart, layoutOf, line, titled } from "./charts.js";
import { button, el, select } from "./dom.js";
import { SIDE, mapChart, solveMap } from "./map.js";
import { getAt } from "./paths.js";
import { ANSWERS, flat, inputsOf } from "./quantities.js";
import { RangeBoxes } from "./ranges.js";
import { say } from "./texts.js";

const POINTS = 19;
const COARSE = 3;
const TURN = 2.5; // a value on a logarithmic slider is varied by this factor either way

/** The answers that can be plotted or sought for a result. */
export function answersOf(result) {
  const all = flat(result);
  return ANSWERS.filter(({ key }) => all[key] !== null && all[key] !== undefined);
}

/** The view say("tab.whatif"). */
export class WhatIfView {
  constructor(app) {
    this.id = "whatif";
    this.title = say("tab.whatif");
    this.app = app;
    const place = el("div", { class: "chart", id: "chart-whatif" });
    this.chart = new Chart(place);
    this.asks = el("div", { class: "ask" });
    const put = (path, range) => {
      const { whatif } = app.store.state.view;
      app.store.view({ whatif: { ...whatif, ranges: { ...whatif.ranges, [path]: range } } });
    };
    this.range = new RangeBoxes("whatif", app, put);
    this.across = new RangeBoxes("whatif-second", app, put);
    this.said = el("p", { class: "hint", id: "whatif-said" });
    const exports = ["PNG", "SVG", "CSV"].map((format) =>
      button(format, () => app.exportChart(format), {
        kind: "small",
        id: `whatif-${format.toLowerCase()}`,
        label: say("chart.save", { format }),
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
    const { path, answer } = this.view;
    const input = inputs.find((one) => one.path === path) ?? inputs[0];
    const asked = answers.find(({ key }) => key === answer) ?? answers[0];
    const others = inputs.filter((one) => one.path !== input.path);
    const second = others.find((one) => one.path === this.view.second);
    this.choose(inputs, answers, input, asked, second);
    const [first, across] = [input, second].map((one) => one && this.rangeOf(one, getAt(tree, one.path)));
    this.range.show(input, first);
    for (const node of this.across.nodes) node.hidden = !second;
    if (second) this.across.show(second, across);
    const values = spread(first, input.log, second ? SIDE : POINTS);
    const ys = second ? spread(across, second.log, SIDE) : [];
    const key = JSON.stringify([tree, input.path, values, second?.path, ys]);
    const now = {
      value: getAt(tree, input.path),
      second: second && getAt(tree, second.path),
      result: flat(result),
    };
    this.asking = { key, tree, input, second, asked, now, xs: values, ys };
    if (second) return this.showMap();
    if (this.sweep?.key === key) this.draw();
    else {
      if (!this.shown) this.begin(values);
      await this.fetch(key, tree, input.path, values);
    }
    return undefined;
  }

  get view() {
    return this.app.store.state.view.whatif;
  }

  /** From where to where an input is varied. */
  rangeOf(input, now) {
    return this.view.ranges?.[input.path] ?? usualRange(input, now);
  }

  /** The map over two inputs, row by row. */
  async showMap() {
    const asking = this.asking;
    const draw = (rows) => {
      const isWhole = rows.every((row) => row);
      this.map = { ...asking, rows, isWhole };
      this.shown = this.map;
      this.chart.node.classList.toggle("old", !isWhole);
      this.said.textContent = isWhole ? say("map.said") : say("whatif.computing");
      this.chart.show(mapChart(this.map, this.app.units(), this.app.palette()));
    };
    if (this.map?.key === asking.key && this.map.isWhole) return draw(this.map.rows);
    this.abort?.abort();
    const abort = new AbortController();
    this.abort = abort;
    this.said.textContent = say("whatif.computing");
    this.chart.node.classList.add("old");
    try {
      await solveMap(asking, abort.signal, (rows) => this.asking.key === asking.key && draw(rows));
    } catch (error) {
      if (!isAbort(error)) this.said.textContent = error.message;
    }
    return undefined;
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
    if (this.asking?.second) return this.map?.key !== this.asking.key || !this.map.isWhole;
    return this.sweep?.key !== this.asking?.key || this.sweep.values.length < POINTS;
  }

  choose(inputs, answers, input, asked, second) {
    const key = JSON.stringify([
      second?.path,
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
        label: say("whatif.how"),
        options: answers.map((one) => [one.key, one.label]),
        value: asked.key,
        act: (value) => put({ answer: value }),
      }),
      select({
        id: "whatif-path",
        label: say("whatif.with"),
        options: inputs.map((one) => [one.path, one.label]),
        value: input.path,
        act: (value) => put({ path: value }),
      }),
      ...this.range.nodes,
      select({
        id: "whatif-second",
        label: say("map.and"),
        options: [
          ["", say("map.nothing")],
          ...inputs.filter((one) => one.path !== input.path).map((one) => [one.path, one.label]),
        ],
        value: second?.path ?? "",
        act: (value) => put({ second: value }),
      }),
      ...this.across.nodes,
    );
    if (focused) document.getElementById(focused)?.focus();
  }

  /** Every third value first, so that a curve is soon there; then the others. */
  async fetch(key, tree, path, values) {
    this.abort?.abort();
    const abort = new AbortController();
    this.abort = abort;
    this.said.textContent = say("whatif.computing");
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
    if (this.sweep.key !== this.asking.key || this.asking.second) return;
    const { results } = this.sweep;
    const lost = results.filter((one) => !isSound(one)).length;
    if (results.length < POINTS) this.said.textContent = say("whatif.computing");
    else
      this.said.textContent = lost
        ? say("whatif.lost", { lost, count: results.length })
        : say("whatif.said");
    this.chart.node.classList.remove("old");
    this.shown = { ...this.asking, sweep: this.sweep };
    this.chart.show(curve(this.shown, this.app.units(), this.app.palette()));
  }

  figure(_snapshot, palette) {
    if (!this.shown) return null;
    const draw = this.shown.rows ? mapChart : curve;
    return draw(this.shown, this.app.units(), palette);
  }
}

function isSound(one) {
  return !one.error && one.converged !== false;
}

/** The range around the present value, without what no slider could reach. */
function usualRange({ low, high, log, factor }, now) {
  if (log) return [now / TURN, now * TURN];
  return [Math.min(low / factor, now), Math.max(high / factor, now)];
}

/** So many values from end to end, in equal steps or, on a logarithmic scale, equal factors. */
function spread([first, last], log, count) {
  const isLog = log && first > 0;
  const at = (share) => (isLog ? first * (last / first) ** share : first + (last - first) * share);
  return Array.from({ length: count }, (_none, i) => Number(at(i / (count - 1)).toPrecision(8)));
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
      name: say("whatif.design"),
      x: [units.shown(now.value * factor, dimension)],
      y: units.list([now.result[asked.key]], asked.dimension),
      marker: { size: 13, color: palette.shear, line: { color: palette.ground, width: 2 } },
      hovertemplate: hover,
      showlegend: false,
    },
  ];
  const layout = layoutOf(palette, titled(label, own), titled(asked.label, unit), { hovermode: "closest" });
  return { data, layout, label: say("whatif.label", { answer: asked.label, input: label }) };
}
