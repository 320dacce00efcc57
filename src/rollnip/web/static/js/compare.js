// Up to four designs: curves over each other, figures beside each other.

import { SOLVE, post } from "./api.js";
import { Chart } from "./charts.js";
import { nameOf } from "./design.js";
import { button, el, select } from "./dom.js";
import { letter, overlay } from "./plots.js";
import { ANSWERS, figureIn, flat } from "./quantities.js";
import { number } from "./units.js";
import { say } from "./texts.js";

export const MOST_KEPT = 3; // beside the design at hand
const REFUSED = 422; // by the server: asking again would not help
const SOUND = new Map([
  [true, say("compare.yes")],
  [false, say("compare.no")],
  [undefined, say("compare.no-answer")],
]);
const PROFILES = ["pressure", "shear", "gap", "strain_upper", "strain_lower"].map((key) => {
  const { label: title, dimension } = figureIn("profile", key);
  return { key, title, dimension };
});

/** The view say("tab.compare"). */
export class CompareView {
  constructor(app) {
    this.id = "compare";
    this.title = say("tab.compare");
    this.app = app;
    this.results = new Map();
    this.turn = 0;
    const place = el("div", { class: "chart", id: "chart-compare" });
    this.chart = new Chart(place);
    this.bar = el("div", { class: "ask" });
    this.table = el("div", {
      class: "scroll",
      tabindex: "0",
      role: "region",
      "aria-label": say("compare.table"),
    });
    this.empty = el("p", {
      class: "empty",
      text: say("compare.empty"),
    });
    this.node = el("div", {}, this.bar, this.empty, place, this.table);
  }

  async show({ tree, result, state }) {
    const { kept } = this.app.store.state;
    this.build(kept);
    this.empty.hidden = kept.length > 0;
    this.chart.node.hidden = kept.length === 0;
    this.table.hidden = kept.length === 0;
    if (kept.length === 0) return;
    if (state !== "preview") this.results.set(JSON.stringify(tree), result);
    const turn = (this.turn += 1);
    await this.fill(kept);
    if (turn !== this.turn) return;
    const others = kept.map((one) => ({ tree: one, result: this.results.get(JSON.stringify(one)) ?? null }));
    this.designs = [...others, { tree, result }];
    this.chart.show(this.plot(this.app.palette()));
    this.table.replaceChildren(this.rows());
  }

  /** Solve the kept designs that were not solved yet, such as those of a link. */
  async fill(kept) {
    for (const one of kept) {
      const key = JSON.stringify(one);
      if (this.results.has(key)) continue;
      try {
        this.results.set(key, await post(SOLVE, one));
      } catch (error) {
        if (error.status === REFUSED) this.results.set(key, null);
        this.app.complain(say("compare.unsolved", { name: nameOf(one), why: error.message }));
      }
    }
  }

  build(kept) {
    const view = this.app.store.state.view.compare;
    const options = PROFILES.map(({ key, title }) => [key, title]);
    const full = kept.length >= MOST_KEPT;
    const key = `${kept.length} ${view.profile}`;
    if (key === this.key) return;
    this.key = key;
    const focused = document.activeElement?.id;
    const act = (profile) => this.app.store.view({ compare: { profile } });
    const exports = ["PNG", "SVG"].map((format) =>
      button(format, () => this.app.exportChart(format), {
        kind: "small",
        id: `compare-${format.toLowerCase()}`,
        label: say("chart.save", { format }),
      }),
    );
    this.bar.replaceChildren(
      button(full ? say("compare.full") : say("compare.keep"), () => this.app.keep(), {
        kind: "main",
        id: "keep",
        disabled: full,
      }),
      ...(kept.length
        ? [select({ id: "compare-profile", label: say("compare.curve"), options, value: view.profile, act }), ...exports]
        : []),
    );
    if (focused) document.getElementById(focused)?.focus();
  }

  plot(palette) {
    const { profile } = this.app.store.state.view.compare;
    return overlay(
      this.designs,
      PROFILES.find(({ key }) => key === profile) ?? PROFILES[0],
      this.app.units(),
      palette,
    );
  }

  figure(_snapshot, palette) {
    return this.designs ? this.plot(palette) : null;
  }

  /** The table; every design after the first with its difference to the first. */
  rows() {
    const palette = this.app.palette();
    const all = this.designs.map(({ result }) => (result ? flat(result) : {}));
    const keys = ANSWERS.filter(({ key }) =>
      all.some((one) => one[key] !== null && one[key] !== undefined),
    );
    const heads = this.designs.map(({ tree }, i) => this.head(tree, i, palette));
    const body = keys.map((answer) =>
      el(
        "tr",
        {},
        el("th", { scope: "row", text: answer.label }),
        ...all.map((one, i) => this.cell(one, i ? all[0] : null, answer)),
      ),
    );
    const sound = el(
      "tr",
      {},
      el("th", { scope: "row", text: say("compare.converged") }),
      ...all.map((one) =>
        el("td", { class: one.converged ? null : "bad", text: SOUND.get(one.converged) }),
      ),
    );
    return el(
      "table",
      { class: "compare" },
      el("thead", {}, el("tr", {}, el("th", { scope: "col", text: say("compare.figure") }), ...heads)),
      el("tbody", {}, ...body, sound),
    );
  }

  head(tree, i, palette) {
    const key = el("i", { class: "key" });
    key.style.background = palette.designs[i];
    const isNow = i === this.designs.length - 1;
    const name = isNow ? say("compare.at-hand", { name: nameOf(tree) }) : nameOf(tree);
    const open = button(say("compare.open"), () => this.app.openKept(i), {
      kind: "small",
      id: `kept-open-${i}`,
      label: say("compare.open-one", { name }),
    });
    const drop = button(say("action.remove"), () => this.app.dropKept(i), {
      kind: "small",
      id: `kept-drop-${i}`,
      label: say("action.remove-one", { name }),
    });
    return el(
      "th",
      { scope: "col" },
      el("span", { title: name }, key, letter(i, name)),
      isNow ? null : el("div", { class: "row" }, open, drop),
    );
  }

  cell(one, first, { key, dimension, digits }) {
    const units = this.app.units();
    const value = one[key];
    const text = units.text(value, dimension, digits);
    return el(
      "td",
      {},
      text,
      first ? el("span", { class: "change", text: difference(value, first[key], dimension, units) }) : null,
    );
  }
}

/** In per cent where that means something, else plain. */
function difference(value, first, dimension, units) {
  if (value === null || value === undefined || first === null || first === undefined) return "";
  const by = value - first;
  const sign = by > 0 ? "+" : "";
  if (dimension === "share") return say("compare.points", { change: `${sign}${number(units.shown(by, dimension), 3)}` });
  if (Math.abs(first) < 1e-9) return "";
  const percent = (100 * by) / Math.abs(first);
  if (percent > 1000) return say("compare.times", { factor: number(value / first, 3) });
  return Math.abs(percent) < 0.005 ? say("compare.same") : `${sign}${number(percent, 3)} %`;
}
