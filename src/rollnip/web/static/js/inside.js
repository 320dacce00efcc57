// Contours of stress inside the layers.

import { isAbort, post } from "./api.js";
import { Chart, layoutOf, line, titled } from "./charts.js";
import { button, el, select } from "./dom.js";
import { MORE_FIGURES } from "./figures.js";
import { same } from "./paths.js";
import { Probe, bondTable, fieldRows } from "./probe.js";
import { curveName } from "./quantities.js";
import { say } from "./texts.js";

const POINTS = { nx: 120, nz: 40 };
const SIGNED = ["s_zz", "s_xx", "s_xz", "u_x", "u_z"];
const SENT = { von_mises: "mises", loss_density: "loss" }; // keys of the answer that differ
const FIELDS = Object.entries(MORE_FIGURES.inside).map(([key, { dimension }]) => ({
  key: SENT[key] ?? key,
  title: curveName("inside", key),
  dimension,
  signed: SIGNED.includes(key),
}));

/** The view say("tab.inside"). */
export class InsideView {
  constructor(app) {
    this.id = "inside";
    this.title = say("tab.inside");
    this.app = app;
    const place = el("div", { class: "chart", id: "chart-inside" });
    this.chart = new Chart(place);
    this.asks = el("div", { class: "ask" });
    this.said = el("p", { class: "empty" });
    const exports = ["PNG", "SVG", "CSV"].map((format) =>
      button(format, () => app.exportChart(format), {
        kind: "small",
        id: `inside-${format.toLowerCase()}`,
        label: say("chart.save", { format }),
      }),
    );
    this.strain = el("span", { id: "inside-strain" });
    const foot = el(
      "div",
      { class: "chart-foot" },
      el("p", { class: "hint" }, say("inside.hint"), " ", this.strain),
      el("div", { class: "row" }, ...exports),
    );
    this.probe = new Probe(app, FIELDS);
    this.bonds = el("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": say("bond.title") });
    this.node = el("div", {}, this.asks, place, this.said, foot, this.probe.node, this.bonds);
    this.answer = null;
    place.addEventListener("drawn", () => this.hear(place));
  }

  /** A click on the picture probes the point. */
  hear(place) {
    if (this.isHeard) return;
    this.isHeard = true;
    place.on("plotly_click", ({ points: [point] }) => {
      const units = this.app.units();
      this.probe.at(units.base(point.x, "length"), units.base(point.y, "length"));
    });
  }

  /** Whether what is shown is of another design. */
  isOld() {
    return !this.answer || !same(this.answer.tree, this.app.store.state.case);
  }

  /** The field as rows of a table. */
  csvRows() {
    return fieldRows(this.shown.field, FIELDS, this.app.units());
  }

  /** Asks for the field of a settled design, once; draws it in the units and colours of now. */
  async show({ tree, result, state }) {
    const sides = ["upper", "lower"].filter((side) => tree[side].layers.length || tree[side].core);
    if (sides.length === 0) return this.say(say("inside.rigid"));
    const view = this.app.store.state.view.inside;
    const roller = sides.includes(view.roller) ? view.roller : sides[0];
    if (state === "preview") return undefined;
    const key = JSON.stringify([tree, roller]);
    this.mark(this.answer?.key !== key);
    if (this.answer?.key !== key) await this.fetch(key, tree, roller);
    if (this.answer?.key === key) this.draw(sides, roller, result);
    return undefined;
  }

  /** Grey where what is shown is of other inputs. */
  mark(isOld) {
    for (const node of [this.chart.node, this.probe.node, this.bonds]) node.classList.toggle("old", isOld);
  }

  async fetch(key, tree, roller) {
    this.abort?.abort();
    const abort = new AbortController();
    this.abort = abort;
    try {
      const [field, result] = await Promise.all([
        post("/api/interior", { case: tree, roller, ...POINTS }, abort.signal),
        post("/api/solve?whole=false", tree, abort.signal), // with the stresses on interfaces
      ]);
      this.answer = { key, tree, field, interfaces: result.interfaces };
    } catch (error) {
      if (!isAbort(error)) this.say(error.message);
    }
  }

  say(text) {
    this.said.textContent = text;
    this.said.hidden = !text;
    for (const node of [this.probe.node, this.bonds]) node.hidden = Boolean(text);
    this.chart.node.hidden = Boolean(text);
  }

  draw(sides, roller, result) {
    const { field } = this.answer;
    this.mark(false);
    const there = FIELDS.filter(({ key }) => field[key]);
    const view = this.app.store.state.view.inside;
    const chosen = there.find(({ key }) => key === view.field) ?? there[0];
    this.say("");
    this.strain.textContent = say(field.finite_strain ? "inside.finite" : "inside.linear");
    this.shown = { field, chosen, roller, result };
    this.choose(sides, roller, there, chosen);
    this.probe.show(field);
    this.bonds.replaceChildren(bondTable(this.answer.interfaces, this.app.units()));
    this.chart.show(contours(this.shown, this.app.units(), this.app.palette()));
  }

  choose(sides, roller, there, chosen) {
    const key = `${sides} ${roller} ${there.map((one) => one.key)} ${chosen.key}`;
    if (key === this.chosenKey) return;
    this.chosenKey = key;
    const put = (change) =>
      this.app.store.view({ inside: { ...this.app.store.state.view.inside, ...change } });
    const focused = document.activeElement?.id;
    this.asks.replaceChildren(
      select({
        id: "inside-field",
        label: say("inside.show"),
        options: there.map((one) => [one.key, one.title]),
        value: chosen.key,
        act: (value) => put({ field: value }),
      }),
      select({
        id: "inside-roller",
        label: say("inside.of"),
        options: sides.map((side) => [side, say(`roller.${side}`)]),
        value: roller,
        act: (value) => put({ roller: value }),
      }),
    );
    if (focused) document.getElementById(focused)?.focus();
  }

  figure(_snapshot, palette) {
    return this.shown ? contours(this.shown, this.app.units(), palette) : null;
  }
}

/** The contour chart of one field. */
function contours({ field, chosen, roller, result }, units, palette) {
  const length = units.name("length");
  const values = field[chosen.key].map((row) => units.list(row, chosen.dimension));
  const unit = units.name(chosen.dimension);
  const x = units.list(field.x, "length");
  const bar = {
    title: { text: titled(chosen.title, unit), side: "right" },
    thickness: 13,
    outlinewidth: 0,
    tickcolor: palette.bound,
  };
  const map = {
    type: "contour",
    x,
    y: units.list(field.z, "length"),
    z: values,
    ncontours: 18,
    colorscale: chosen.signed ? palette.diverging : palette.sequential,
    ...(chosen.signed ? symmetric(values) : {}),
    contours: { coloring: "fill", showlines: true },
    line: { width: 0.5, color: `${palette.ink}55` },
    colorbar: bar,
    hovertemplate: say("inside.hover", { length, unit }),
  };
  const edges = units.list([result.contact[0][0], result.contact[result.contact.length - 1][1]], "length");
  const nip = line(say("inside.nip"), edges, [0, 0], palette.ink, { width: 5, showlegend: false, hoverinfo: "skip" });
  const layout = layoutOf(
    palette,
    titled(say("axis.along"), length) + say("axis.ends"),
    titled(say("inside.depth"), length),
    {
      yaxis: { autorange: roller === "lower" ? "reversed" : true, zeroline: false },
      shapes: (field.interfaces ?? []).map((depth) => interfaceLine(units.shown(depth, "length"), palette)),
      hovermode: "closest",
    },
  );
  return {
    data: [map, nip],
    layout,
    label: say("inside.label", { field: chosen.title, side: say(`side.${roller}`) }),
  };
}

function symmetric(values) {
  const most = values
    .flat()
    .reduce((high, value) => (value === null ? high : Math.max(high, Math.abs(value))), 0);
  return { zmin: -most, zmax: most, zauto: false };
}

function interfaceLine(depth, palette) {
  return {
    type: "line",
    xref: "paper",
    x0: 0,
    x1: 1,
    yref: "y",
    y0: depth,
    y1: depth,
    line: { color: palette.ink, width: 1 },
  };
}
