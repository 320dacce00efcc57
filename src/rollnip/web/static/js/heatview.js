// Heat: how warm the rollers get, where the heat goes, how they warm up, when they run away.

import { foreignHint, sentenceItems } from "./answers.js";
import { isAbort, post } from "./api.js";
import { Chart } from "./charts.js";
import { button, el, select, withUnit } from "./dom.js";
import { coreKind, losesHeat, withHeat } from "./heat.js";
import { branchChart, depthChart, depthRows, warmChart } from "./heatcharts.js";
import { same } from "./paths.js";
import { complaintsOf, refused } from "./places.js";
import { pressKind } from "./press.js";
import { figureIn, figureOfNip } from "./quantities.js";
import { inWords } from "./said.js";
import { say } from "./texts.js";
import { number } from "./units.js";

const SIDES = ["upper", "lower"];
const FINEST = 1e-4; // %, of a balance that is shown
const TEMPERATURES = ["hot_spot", "hot_spot_depth", "bond_temperature", "surface_temperature", "growth"];
const POWERS = ["viscous", "friction", "to_air", "to_core", "to_nip"];
const NIP = ["nip_width", "peak_pressure", "approach", "load", "creepage", "rolling_resistance"];

/** How the heat of a design is asked for: once the design rests. */
export const HEAT_ROUTE = {
  path: "/api/heat",
  tab: null,
  isWanted: (tree) => Boolean(tree.heat),
};

/** The view "Heat". */
export class HeatView {
  constructor(app) {
    this.id = "heat";
    this.title = say("heat.title");
    this.app = app;
    const start = () => app.store.design({ case: withHeat(app.store.state.case) });
    this.none = el(
      "div",
      { class: "empty" },
      el("p", { text: say("heat.none") }),
      button(say("heat.give"), start, { kind: "main", id: "give-heat" }),
    );
    this.said = el("p", { class: "wrong", id: "heat-said", role: "status" });
    this.verdict = el("p", { class: "heat-verdict", id: "heat-verdict", role: "status" });
    this.chart = new Chart(el("div", { class: "chart low", id: "chart-heat" }));
    this.tables = el("div", { class: "heat-tables", id: "heat-tables" });
    this.notes = el("ul", { class: "warnings", id: "heat-notes" });
    this.english = el("p", { class: "hint", id: "heat-english" });
    this.asks = el("div", { class: "ask" });
    this.more = new Map(["warm-up", "runaway"].map((kind) => [kind, new Further(kind, app)]));
    this.whole = el("div", { class: "face heat" }, this.said, this.verdict, this.chart.node, this.foot(), this.tables, this.notes, this.english, this.asks, ...Array.from(this.more.values(), ({ node }) => node));
    this.node = el("div", {}, this.none, this.whole);
  }

  foot() {
    const exports = ["PNG", "SVG", "CSV"].map((format) =>
      button(format, () => this.app.exportChart(format), {
        kind: "small",
        id: `heat-${format.toLowerCase()}`,
        label: say("chart.save", { format }),
      }),
    );
    return el("div", { class: "chart-foot" }, el("p", { class: "hint", text: say("heat.foot") }), el("div", { class: "row" }, ...exports));
  }

  /** Called with every answer; the heat of a design comes by itself. */
  show() {
    this.refresh();
  }

  /** Show the design at hand, and its heat where that is there. */
  refresh() {
    if (!this.node.isConnected) return;
    const { case: tree, view } = this.app.store.state;
    this.none.hidden = Boolean(tree.heat);
    this.whole.hidden = !tree.heat;
    if (!tree.heat) return;
    this.build(view);
    const failure = this.app.heats.failureOf(tree);
    this.said.textContent = failure ? refused(failure, tree, this.app) : "";
    this.said.hidden = !failure;
    const heat = this.app.heats.of(tree);
    if (heat) this.draw(tree, heat);
    else if (!failure) this.verdict.textContent = say("heat.busy");
    this.verdict.hidden = Boolean(failure);
    for (const node of [this.chart.node, this.tables]) node.classList.toggle("old", !heat);
    for (const one of this.more.values()) one.refresh(tree, heat);
  }

  /** The questions, anew where what can be asked has changed. */
  build(view) {
    const isLoaded = pressKind(this.app) === "load";
    const key = JSON.stringify([isLoaded, view.heat]);
    if (key === this.key) return;
    this.key = key;
    const parameter = isLoaded ? view.heat.parameter : "speed";
    const choose = (value) => this.app.store.view({ heat: { ...this.app.store.state.view.heat, parameter: value } });
    const options = ["speed", ...(isLoaded ? ["load"] : [])].map((name) => [name, say(`heat.over-${name}`)]);
    this.asks.replaceChildren(
      button(say("heat.ask-warm"), () => this.more.get("warm-up").ask({}), { kind: "main", id: "warm-up-go" }),
      select({ id: "runaway-over", label: say("heat.over"), options, value: parameter, act: choose }),
      button(say("heat.ask-runaway"), () => this.more.get("runaway").ask({ parameter }), { kind: "main", id: "runaway-go" }),
    );
  }

  draw(tree, heat) {
    const [units, palette] = [this.app.units(), this.app.palette()];
    this.verdict.textContent = verdictOf(heat, units);
    this.verdict.classList.toggle("not", !heat.converged || heat.stable === false);
    this.chart.node.hidden = !heat.converged;
    if (heat.converged) this.chart.show(depthChart(heat, tree, units, palette));
    this.tables.replaceChildren(...(heat.converged ? heatTables(heat, tree, units) : []));
    const said = this.app.result()?.warnings ?? []; // of the nip, which has its own place
    const own = heat.warnings.filter((text) => !said.includes(text));
    const notes = [...(heat.converged ? [] : [heat.status]), ...own];
    const elastic = losesHeat(tree) ? [] : [el("li", { text: say("heat.elastic") })];
    this.notes.replaceChildren(...elastic, ...sentenceItems(notes, units));
    this.english.textContent = foreignHint(notes);
  }

  /** Whether what is drawn is of another design. */
  isOld() {
    return !this.app.heats.of(this.app.store.state.case);
  }

  figure({ tree }, palette) {
    const heat = this.app.heats.of(tree);
    return heat?.converged ? depthChart(heat, tree, this.app.units(), palette) : null;
  }

  csvRows() {
    const { case: tree } = this.app.store.state;
    return depthRows(this.app.heats.of(tree), tree, this.app.units());
  }
}

/** What is asked for with a button: the warm-up or the way to runaway. The newest question wins. */
class Further {
  constructor(kind, app) {
    this.kind = kind;
    this.app = app;
    this.answer = null; // {tree, heat, result}
    this.asking = null; // AbortController of the question under way
    this.said = el("p", { role: "status", id: `${kind}-said` });
    this.chart = new Chart(el("div", { class: "chart low", id: `chart-${kind}` }));
    this.node = el("div", { class: "heat-more", hidden: true }, this.said, this.chart.node);
  }

  async ask(more) {
    const { case: tree } = this.app.store.state;
    this.asking?.abort();
    const asking = new AbortController();
    this.asking = asking;
    this.tree = tree;
    this.answer = null;
    this.node.hidden = false;
    this.chart.node.hidden = true;
    this.said.classList.remove("wrong");
    this.said.textContent = say(`heat.busy-${this.kind}`);
    try {
      const body = this.kind === "runaway" ? { case: tree, ...more } : tree;
      const result = await post(`/api/${this.kind}`, body, asking.signal);
      this.answer = { tree, result };
      this.show();
    } catch (error) {
      if (isAbort(error)) return;
      this.said.classList.add("wrong");
      this.said.textContent = complaintsOf(error, tree, this.app.units()).join(" ");
    } finally {
      if (this.asking === asking) this.asking = null;
    }
  }

  /** An answer to another design goes, and so does a question that nobody waits for any more. */
  refresh(tree) {
    if (this.tree && !same(withoutTitle(this.tree), withoutTitle(tree))) {
      this.asking?.abort();
      [this.tree, this.answer] = [null, null];
      this.node.hidden = true;
    } else if (this.answer) this.show();
  }

  show() {
    const [units, palette] = [this.app.units(), this.app.palette()];
    const { tree, result } = this.answer;
    const heat = this.app.heats.of(tree);
    if (!heat) return;
    this.chart.node.hidden = false;
    this.said.textContent = this.kind === "runaway" ? branchSentence(result, units) : warmSentence(result, units);
    const drawn = this.kind === "runaway" ? branchChart(result, heat, units, palette) : warmChart(result, units, palette);
    this.chart.show(drawn);
  }
}

function withoutTitle(tree) {
  return { ...tree, title: "" };
}

/** The verdict in a sentence. */
function verdictOf(heat, units) {
  if (!heat.converged) return say(/No steady state|runs away/.test(heat.status) ? "heat.no-steady" : "heat.unsound");
  const side = heat.upper.hot_spot >= heat.lower.hot_spot ? "upper" : "lower";
  const { hot_spot: hot, hot_spot_depth: depth } = heat[side];
  const isEven = new Set(SIDES.flatMap((one) => heat[one].temperature)).size === 1;
  const values = { hot: units.figure(figureIn("heat", "hot_spot"), hot), depth: units.figure(figureIn("heat", "hot_spot_depth"), depth) };
  if (heat.stable === false) return say(`heat.unstable-${side}`, values);
  return say(isEven ? "heat.steady-even" : `heat.steady-${side}`, values);
}

function warmSentence(course, units) {
  if (!course.converged) return inWords(course.status, "", units);
  const half = course.half_time;
  return half === null ? say("heat.no-half") : say("heat.half", { time: units.figure(figureIn("warm", "half_time"), half) });
}

function branchSentence(branch, units) {
  const over = figureIn("course", branch.parameter);
  if (!branch.turning) {
    const far = branch.points[branch.points.length - 1].value;
    return `${say("heat.no-runaway", { value: units.figure(over, far) })} ${branch.reached ? "" : inWords(branch.status, "", units)}`.trim();
  }
  const { value, hot_spot: hot } = branch.turning;
  const values = {
    value: units.figure(over, value),
    hot: units.figure(figureIn("heat", "hot_spot"), hot),
    share: number(100 * branch.margin, 3),
  };
  return say(`heat.${branch.margin > 0 ? "runs-away" : "beyond"}-${branch.parameter}`, values);
}

/** Figures of heat as {key, label, cells}: {text, unit} of the upper and the lower roller, or cold and warm. */
export function heatRows(heat, tree, units) {
  const row = (key, values, { label, dimension, digits }) => ({
    key,
    label,
    cells: values.map((value) => units.format(value, dimension, digits)),
  });
  const both = (key) => row(key, SIDES.map((side) => heat[side][key]), figureIn("heat", key));
  const temperatures = TEMPERATURES.map(both);
  const powers = POWERS.filter((key) => key !== "to_core" || SIDES.some((side) => tree[side].heat && coreKind(tree[side].heat) !== "insulated")).map(both);
  if (SIDES.some((side) => tree[side].radius === "inf")) powers.push(both("carried"));
  if (tree.heat.sheet) powers.push(row("to_sheet", [heat.to_sheet], figureIn("heat", "to_sheet")));
  powers.push(both("power"));
  const nip = NIP.map((key) => row(`nip-${key}`, [heat.cold[key], heat.warm[key]], figureOfNip(key)));
  return { temperatures, powers, nip };
}

/** Temperatures, powers, and the warm nip beside the cold one, as tables. */
export function heatTables(heat, tree, units) {
  const { temperatures, powers, nip } = heatRows(heat, tree, units);
  const sides = SIDES.map((side) => say(`heat.${side}`));
  const closed = say("heat.closed", { balance: number(Math.max(100 * Math.abs(heat.balance), FINEST), 1) });
  return [
    tableOf(say("heat.temperatures"), sides, temperatures),
    tableOf(say("heat.powers"), sides, powers, closed),
    tableOf(say("heat.nip"), [say("heat.cold"), say("heat.warm")], nip),
  ];
}

function tableOf(title, heads, rows, note = "") {
  const head = el("tr", {}, el("th", { scope: "col", text: title }), ...heads.map((text) => el("th", { scope: "col", text })));
  const body = rows.map(({ key, label, cells }) =>
    el("tr", { "data-heat": key }, el("th", { scope: "row", text: label }), ...cells.map(({ text, unit }) => el("td", {}, ...withUnit({ text, unit })))),
  );
  const table = el("table", { class: "compare" }, el("thead", {}, head), el("tbody", {}, ...body));
  return el("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": title }, table, note ? el("p", { class: "hint", text: note }) : null);
}
