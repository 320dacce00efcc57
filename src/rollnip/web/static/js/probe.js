// Inside a covering: the values at one point, and the stresses on bonds.

import { isAbort, post } from "./api.js";
import { questionOf } from "./control.js";
import { el } from "./dom.js";
import { figureIn } from "./quantities.js";
import { say } from "./texts.js";

/** The values of every field at one computed point; `fields` are {key, title, dimension}. */
export class Probe {
  constructor(app, fields) {
    this.app = app;
    this.fields = fields;
    this.point = null; // {x, z} as asked for [mm]
    this.boxes = ["x", "z"].map((axis) => this.box(axis));
    this.values = el("dl", { class: "probe-values", id: "probe-values" });
    this.place = el("p", { class: "hint", id: "probe-place" });
    this.node = el(
      "div",
      { class: "probe" },
      el("h3", { text: say("probe.title") }),
      el("div", { class: "ask" }, ...this.boxes.map(({ node }) => node)),
      this.place,
      this.values,
    );
  }

  box(axis) {
    const id = `probe-${axis}`;
    const input = el("input", { type: "text", id, autocomplete: "off", value: "0" });
    const label = el("label", { for: id, text: say(`probe.${axis}`) });
    input.addEventListener("change", () => this.typed());
    return { axis, input, label, node: el("div", { class: "field" }, label, input) };
  }

  async typed() {
    const units = this.app.units();
    this.asking?.abort(); // the newest texts hold
    this.asking = new AbortController();
    const { signal } = this.asking;
    const read = async ({ input }) =>
      (await post("/api/quantity", questionOf(input.value.trim(), "length", units), signal)).value;
    try {
      const [x, z] = await Promise.all(this.boxes.map(read));
      this.at(x, z);
    } catch (error) {
      if (isAbort(error)) return;
      this.values.replaceChildren();
      this.place.textContent = error.message;
    }
  }

  /** Ask for the point that is nearest to a place [mm]. */
  at(x, z) {
    this.point = { x, z };
    this.show(this.field);
  }

  /** The values in a field of the server. */
  show(field) {
    this.field = field;
    const units = this.app.units();
    for (const { axis, label } of this.boxes)
      label.textContent = `${say(`probe.${axis}`)} [${units.name("length")}]`;
    const { x = 0, z = 0 } = this.point ?? {};
    const [i, j] = [nearest(field.z, z), nearest(field.x, x)];
    const there = this.fields.filter(({ key }) => field[key]);
    const rows = there.map(({ key, title, dimension }) => {
      const value = field[key][i][j];
      return [title, units.text(value, dimension)];
    });
    const place = say("probe.place", {
      x: units.text(field.x[j], "length", 3),
      z: units.text(field.z[i], "length", 3),
    });
    this.place.textContent = place;
    this.values.replaceChildren(
      ...rows.map(([title, text]) => el("div", {}, el("dt", { text: title }), el("dd", { text }))),
    );
  }
}

function nearest(list, value) {
  let best = 0;
  list.forEach((one, i) => {
    if (Math.abs(one - value) < Math.abs(list[best] - value)) best = i;
  });
  return best;
}

/** Shear and tension on every bond and interface, as a table; `interfaces` as the result has them. */
export function bondTable(interfaces, units) {
  if (interfaces.length === 0) return el("p", { class: "hint", text: say("bond.none") });
  const figures = ["depth", "shear_max", "shear_range", "pull"].map((key) => figureIn("bond", key).label);
  const head = [say("bond.where"), ...figures].map((text) => el("th", { scope: "col", text }));
  const rows = interfaces.map((one) => {
    const shear = Math.max(Math.abs(one.shear_min), Math.abs(one.shear_max));
    const name = say(one.bond ? "bond.core" : "bond.between", { roller: say(`side.${one.roller}`) });
    const text = (key, value) => units.figure(figureIn("bond", key), value);
    const peel = one.peel_max > 0 ? text("pull", one.peel_max) : say("bond.pressed");
    const cells = [text("depth", one.depth), text("shear_max", shear), text("shear_range", one.shear_range), peel];
    return el("tr", {}, el("th", { scope: "row", text: name }), ...cells.map((text) => el("td", { text })));
  });
  return el(
    "table",
    { class: "bonds", id: "bonds" },
    el("caption", { text: say("bond.title") }),
    el("thead", {}, el("tr", {}, ...head)),
    el("tbody", {}, ...rows),
  );
}

/** A field as CSV: a row for each point. */
export function fieldRows(field, fields, units) {
  const there = fields.filter(({ key }) => field[key]);
  const head = there.map(({ title, dimension }) => `${title} [${units.of(dimension).name}]`);
  const length = units.of("length").name;
  const rows = field.z.flatMap((z, i) =>
    field.x.map((x, j) => [
      units.shown(x, "length"),
      units.shown(z, "length"),
      field.layer[i]?.[j] ?? field.layer[i],
      ...there.map(({ key, dimension }) => {
        const value = field[key][i][j];
        return value === null ? null : units.shown(value, dimension);
      }),
    ]),
  );
  return [[`x [${length}]`, `depth [${length}]`, "layer", ...head], ...rows];
}
