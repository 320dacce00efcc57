// A nip impression: widths that were measured along the face, and what they tell.

import { isAbort, post, sentencesOf } from "./api.js";
import { sentenceItems } from "./answers.js";
import { button, checkbox, el, select } from "./dom.js";
import { SIDES, byEndLoads, endLoads, meanLoad } from "./face.js";
import { same, setAt } from "./paths.js";
import { inWords } from "./said.js";
import { numbersOf } from "./tablebox.js";
import { say } from "./texts.js";
import { typable } from "./units.js";

const UNKNOWNS = ["crown", "tilt", "load", "modulus"];
const FIRST = ["crown", "tilt"];
const SCATTER = 0.2; // mm
const DIMENSIONS = { crown: "length", tilt: "roller force", load: "line load", modulus: "ratio" };

/** The part of the view along the face that reads an impression. */
export class ImpressionPart {
  constructor(app) {
    this.app = app;
    this.chosen = new Set(FIRST);
    this.box = el("textarea", { id: "impression-widths", rows: 6, spellcheck: "false", "aria-describedby": "impression-hint impression-wrong" });
    this.label = el("label", { for: "impression-widths", text: say("impression.widths") });
    this.hint = el("p", { class: "hint", id: "impression-hint" });
    this.wrong = el("p", { class: "wrong", id: "impression-wrong", role: "status" });
    this.scatter = el("input", { type: "text", id: "impression-scatter", autocomplete: "off" });
    this.scatterLabel = el("label", { for: "impression-scatter" });
    this.asks = el("div", { class: "ask" });
    this.found = el("div", { role: "status", id: "impression-said" });
    this.node = el(
      "details",
      { class: "fold", id: "impression" },
      el("summary", { text: say("impression.title") }),
      el(
        "div",
        { class: "inner" },
        el("p", { class: "hint", text: say("impression.what") }),
        el("div", { class: "field" }, this.label, this.box, this.hint),
        this.asks,
        this.wrong,
        this.found,
      ),
    );
  }

  /** Follow the design: its units, its rollers, and whether what was found is still of it. */
  refresh(tree) {
    const units = this.app.units();
    const unit = (dimension) => units.name(dimension);
    this.hint.textContent = say("impression.hint", { length: unit("length"), load: unit("line load") });
    this.scatterLabel.textContent = `${say("impression.scatter")} [${unit("length")}]`;
    const rollers = SIDES.filter((side) => tree[side].shaft);
    const key = JSON.stringify([rollers, units.system]);
    if (key !== this.key) this.build(rollers, units);
    this.key = key;
    if (this.told && !same(this.told.tree, tree)) this.found.replaceChildren();
  }

  build(rollers, units) {
    const focused = document.activeElement?.id;
    this.scatter.value = typable(units.shown(SCATTER, "length"), 2);
    const toggle = (name) => (yes) => (yes ? this.chosen.add(name) : this.chosen.delete(name));
    const boxes = UNKNOWNS.map((name) => checkbox(`impression-${name}`, say(`impression.${name}`), this.chosen.has(name), toggle(name)));
    this.roller = rollers.includes(this.roller) ? this.roller : rollers[0];
    this.asks.replaceChildren(
      el("fieldset", { class: "unknowns" }, el("legend", { text: say("impression.unknown") }), ...boxes),
      select({
        id: "impression-roller",
        label: say("crown.of"),
        options: rollers.map((side) => [side, say(`roller.${side}`)]),
        value: this.roller ?? "",
        act: (side) => {
          this.roller = side;
        },
      }),
      el("div", { class: "field short" }, this.scatterLabel, this.scatter),
      button(say("impression.go"), () => this.read(), { kind: "main", id: "impression-go", disabled: rollers.length === 0 }),
    );
    if (focused) document.getElementById(focused)?.focus();
  }

  /** The impressions as typed, [{y, width, load}], those of one load together. Throws where one cannot be read. */
  typed() {
    const units = this.app.units();
    const byLoad = new Map();
    for (const [i, line] of this.box.value.split(/\r?\n/).entries()) {
      if (line.trim() === "") continue;
      const values = numbersOf(line);
      if (!values || values.length < 2 || values.length > 3) throw new Error(say("table.line", { line: i + 1, count: 2, most: 3 }));
      const load = values.length === 3 ? units.base(values[2], "line load") : null;
      const one = byLoad.get(load) ?? { y: [], width: [], load };
      one.y.push(units.base(values[0], "length"));
      one.width.push(units.base(values[1], "length"));
      byLoad.set(load, one);
    }
    if (byLoad.size === 0) throw new Error(say("impression.empty"));
    return [...byLoad.values()];
  }

  scatterTyped() {
    const [value] = numbersOf(this.scatter.value) ?? [];
    if (!(value > 0)) throw new Error(say("impression.scatter-wrong"));
    return this.app.units().base(value, "length");
  }

  async read() {
    const { case: tree } = this.app.store.state;
    this.asking?.abort();
    this.asking = new AbortController();
    this.wrong.textContent = "";
    this.found.replaceChildren(el("p", { class: "hint", text: say("impression.busy") }));
    try {
      const impressions = this.typed();
      const unknowns = UNKNOWNS.filter((name) => this.chosen.has(name));
      if (unknowns.length === 0) throw new Error(say("impression.no-unknown"));
      // Arms and end loads are what an unknown tilt is to tell: the mean load is what is known.
      const load = meanLoad(tree) === null ? null : (this.app.faces.of(tree)?.mean_load ?? meanLoad(tree));
      const whole = load === null ? tree : withMean(tree, load);
      const body = { case: whole, roller: this.roller, unknowns, scatter: this.scatterTyped(), impressions };
      const answer = await post("/api/impression", body, this.asking.signal);
      if (same(tree, this.app.store.state.case)) this.tell(tree, answer);
    } catch (error) {
      if (isAbort(error)) return;
      this.found.replaceChildren();
      const units = this.app.units();
      this.wrong.textContent = (error.details?.length ? error.details.map(({ message }) => inWords(message, "", units)) : sentencesOf(error)).join(" ");
    }
  }

  tell(tree, answer) {
    this.told = { tree };
    const units = this.app.units();
    const text = (value, dimension) => units.text(value, dimension, 3);
    const rows = Object.entries(answer.estimates).map(([name, { value, low, high }]) => {
      const dimension = DIMENSIONS[name];
      return [say(`impression.found-${name}`), text(value, dimension), say("known.range", { low: text(low, dimension), high: text(high, dimension) })];
    });
    const [ends] = answer.end_loads;
    if (answer.estimates.tilt && ends.length === 2)
      rows.push([say("impression.ends"), `${text(ends[0], "roller force")}, ${text(ends[1], "roller force")}`, ""]);
    if (answer.estimates.tilt && answer.bearing_offset !== null) rows.push([say("face.offset"), text(answer.bearing_offset, "length"), ""]);
    rows.push([say("impression.needed"), text(answer.needed_crown, "length"), ""], [say("impression.shop"), text(answer.shop_crown, "length"), ""]);
    const head = [say("patch.figure"), say("patch.value"), say("impression.interval")];
    this.found.replaceChildren(
      el(
        "div",
        { class: "found" },
        el(
          "table",
          { class: "compare", id: "impression-table" },
          el("thead", {}, el("tr", {}, ...head.map((one) => el("th", { scope: "col", text: one })))),
          el("tbody", {}, ...rows.map(([name, ...cells]) => el("tr", {}, el("th", { scope: "row", text: name }), ...cells.map((cell) => el("td", { text: cell }))))),
        ),
        el("ul", { class: "warnings" }, ...sentenceItems(answer.warnings, units)),
        button(say("impression.use"), () => this.use(answer), { kind: "main", id: "impression-use" }),
      ),
    );
  }

  /** Take crown and end loads, as far as they were read, into the design. */
  use({ estimates, end_loads: [ends] }) {
    const { store } = this.app;
    const { case: now } = store.state;
    const round = (value) => Number(value.toPrecision(4));
    let tree = now;
    if (estimates.crown)
      tree = setAt(tree, `${this.roller}.shaft.crown`, { height: round(estimates.crown.value), shape: "parabolic" });
    if (estimates.tilt && tree.upper.shaft)
      tree = setAt(byEndLoads(tree, 0.5), "face.end_loads", ends.map(round));
    else if (estimates.load && !endLoads(tree)) tree = setAt(tree, "nip.load", round(estimates.load.value));
    store.design({ case: tree });
  }
}

function withMean(tree, load) {
  const { end_loads: _ends, arms: _arms, ...face } = tree.face;
  return setAt({ ...tree, face }, "nip.load", load);
}
