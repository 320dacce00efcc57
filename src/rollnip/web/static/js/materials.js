// The material of a layer: from the library, by hardness, or one of the models.

import { kindOf, materialAs } from "./design.js";
import { el, select } from "./dom.js";
import { energyEditor } from "./energy.js";
import { warmedAs } from "./heat.js";
import { rangeText } from "./known.js";
import { getAt, idOf, setAt } from "./paths.js";
import { rowsEditor } from "./rows.js";
import { say } from "./texts.js";

const MODELS = [
  ["shore", say("material.shore")],
  ["elastic", say("material.elastic")],
  ["standard-linear-solid", say("material.sls")],
  ["prony", say("material.prony")],
  ["fractional-zener", say("material.zener")],
  ["loss-factor", say("material.loss-factor")],
];
const NUMBERS = {
  shore: ["shore_a"],
  elastic: [],
  "standard-linear-solid": ["modulus", "stiffening", "relaxation_time"],
  prony: ["modulus"],
  "fractional-zener": ["modulus", "stiffening", "relaxation_time", "order"],
  "loss-factor": ["modulus", "loss_factor"],
};
const LIBRARY = "library:";
const FAMILY = "family:";
const SHIFTS = {
  none: undefined,
  wlf: { model: "wlf", c1: 17.44, c2: 51.6, reference: 23 },
  arrhenius: { model: "arrhenius", activation_energy: 60, reference: 23 },
  table: {
    model: "table",
    reference: 23,
    points: [
      { temperature: 0, factor: 10 },
      { temperature: 23, factor: 1 },
      { temperature: 60, factor: 0.05 },
    ],
  },
};
const READING_TIME = 3; // s, of a durometer on vulcanised rubber (ISO 48-4)
const TERMS = {
  kind: "term",
  names: ["modulus", "relaxation_time"],
  fewest: 1,
  next: (last) => ({ ...last }),
};
const POINTS = {
  kind: "point",
  names: ["temperature", "factor"],
  fewest: 2,
  next: ({ temperature, factor }) => ({ temperature: temperature + 20, factor: factor / 10 }),
};

/** The elements that edit the material at `path`. */
export function materialEditor(path, panel) {
  const material = getAt(panel.app.store.state.case, path);
  const kind = kindOf(material);
  const choice = new Choice(path, panel);
  panel.parts.push(choice);
  return [
    choice.node,
    material.model === "elastic" ? null : givenAs(path, material, panel),
    ...numbers(kind, material).map((name) => panel.control(`${path}.${name}`)),
    kind === "prony" ? rowsEditor(`${path}.terms`, TERMS, panel) : null,
    panel.fold(`${idOf(path)}-more`, say("material.more"), [
      choice.note,
      ...more(path, material, panel),
    ]),
  ];
}

function numbers(kind, material) {
  if (kind !== "elastic") {
    const isHard = kind !== "shore" && material.shore_a !== undefined;
    return NUMBERS[kind].map((name) => (isHard && name === "modulus" ? "shore_a" : name));
  }
  return [material.shear_modulus === undefined ? "modulus" : "shear_modulus"];
}

/** The choice of a material; a slider may turn one of the library into an own one and back. */
class Choice {
  constructor(path, panel) {
    this.path = path;
    this.app = panel.app;
    const library = this.app.library.map(({ name, title }) => [LIBRARY + name, title]);
    const families = this.app.families.map(({ name, title }) => [FAMILY + name, title]);
    const groups = [
      { group: say("material.coverings"), options: families },
      { group: say("material.own"), options: MODELS },
      { group: say("material.library"), options: library },
    ];
    const act = (value) => {
      const { store } = this.app;
      const family = value.startsWith(FAMILY) ? value.slice(FAMILY.length) : undefined;
      const families = { ...store.state.view.families, [path]: family };
      store.state = { ...store.state, view: { ...store.state.view, families } };
      put(panel, path, this.chosen(value));
    };
    this.node = select({ id: `${idOf(path)}-kind`, label: say("material.label"), options: groups, value: "", act });
    this.note = el("p", { class: "note" });
    this.refresh(this.app.store.state.case);
  }

  refresh(tree) {
    const material = getAt(tree, this.path);
    if (!material) return;
    const kind = kindOf(material);
    const family = kind === "shore" ? this.family() : undefined;
    const entry = kind === "shore" ? family : this.app.libraryEntry(material);
    const value = family ? FAMILY + family.name : entry ? LIBRARY + entry.name : kind;
    this.node.querySelector("select").value = value;
    const described = entry ? `${entry.description} ${say("material.source", { source: entry.source })}` : "";
    this.note.textContent =
      kind === "shore" ? `${this.hardness(material.shore_a)} ${described}`.trim() : described;
    this.note.hidden = this.note.textContent === "";
  }

  /** The kind of covering that was chosen here, if any. */
  family() {
    const chosen = this.app.store.state.view.families[this.path];
    return this.app.families.find(({ name }) => name === chosen);
  }

  /** Modulus and band of any hardness, and where they are from. */
  hardness(shore) {
    const found = modulusOf(shore, this.app.hardness);
    if (!found) return "";
    const units = this.app.units();
    return say("material.hardness", {
      likely: units.text(found.likely, "pressure", 2),
      band: rangeText([found.low, found.high], "pressure", units, 2),
    });
  }

  chosen(value) {
    const named = ({ name }) => LIBRARY + name === value || FAMILY + name === value;
    const entry = [...this.app.families, ...this.app.library].find(named);
    const old = getAt(this.app.store.state.case, this.path);
    if (!entry) return materialAs(value, old);
    const { shore_a: now } = old;
    const made = warmedAs(structuredClone(entry.material), old);
    return entry.family && now !== undefined ? { ...made, shore_a: now } : made;
  }
}

/** {low, likely, high} of a hardness, from the table of the server; null outside it. */
export function modulusOf(shore, table) {
  const at = table.shore_a.findIndex((point) => point >= shore);
  if (at < 0 || shore < table.shore_a[0]) return null;
  const before = Math.max(0, at - 1);
  const span = table.shore_a[at] - table.shore_a[before];
  const share = span > 0 ? (shore - table.shore_a[before]) / span : 0;
  const between = (list) => list[before] * (list[at] / list[before]) ** share;
  return { low: between(table.low), likely: between(table.likely), high: between(table.high) };
}

/** Whether the stiffness of a viscoelastic material is given as its modulus or by its hardness. */
function givenAs(path, material, panel) {
  const options = [
    ["modulus", say("given.modulus")],
    ["shore_a", say("given.hardness")],
  ];
  const act = (name) => {
    const { modulus: _m, shore_a: shore, reading_time: _t, ...rest } = material;
    const hard = { ...rest, shore_a: 60, reading_time: READING_TIME };
    put(panel, path, name === "shore_a" ? hard : { ...rest, modulus: panel.app.modulusOf(shore) });
  };
  const value = material.shore_a === undefined ? "modulus" : "shore_a";
  return select({ id: `${idOf(path)}-given`, label: say("given.label"), options, value, act });
}

function more(path, material, panel) {
  const isViscous = material.model !== "elastic";
  return [
    panel.control(`${path}.poisson`),
    isViscous ? shiftEditor(path, material, panel) : null,
    isViscous && material.shift ? panel.control(`${path}.temperature`) : null,
    ...(isViscous ? shiftNumbers(path, material, panel) : []),
    material.shift?.points ? rowsEditor(`${path}.shift.points`, POINTS, panel) : null,
    material.reading_time === undefined ? null : panel.control(`${path}.reading_time`),
    ...energyEditor(path, panel),
  ];
}

function shiftEditor(path, material, panel) {
  const options = [
    ["none", say("shift.none")],
    ["wlf", say("shift.wlf")],
    ["arrhenius", say("shift.arrhenius")],
    ["table", say("shift.table")],
  ];
  const act = (kind) => {
    const shift = SHIFTS[kind];
    const temperature = shift ? (material.temperature ?? 23) : undefined;
    put(panel, path, setAt(setAt(material, "shift", shift), "temperature", temperature));
  };
  return select({
    id: `${idOf(path)}-shift`,
    label: say("input.temperature"),
    options,
    value: material.shift?.model ?? "none",
    act,
  });
}

function shiftNumbers(path, material, panel) {
  const names =
    { wlf: ["c1", "c2", "reference"], arrhenius: ["activation_energy", "reference"], table: ["reference"] }[
      material.shift?.model
    ] ?? [];
  return names.map((name) => panel.control(`${path}.shift.${name}`));
}

function put(panel, path, value) {
  panel.change(setAt(panel.app.store.state.case, path, value));
}
