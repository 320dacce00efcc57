// What varies along a roller: a measured crown, steps of the journals, the covering over the face.

import { checkbox } from "./dom.js";
import { kindOf } from "./design.js";
import { coreDiameter } from "./face.js";
import { modulusOf } from "./materials.js";
import { columnsOf, rowsOf } from "./tablebox.js";
import { say } from "./texts.js";

const CROWN = ["y", "diameter"];
const COVERING = ["y", "thickness", "stiffness"];

/** A crown of another shape; a table begins with the crown there was. */
export function crownAs(shape, crown, length) {
  if (shape === "table") return { y: [-length / 2, 0, length / 2], diameter: [0, crown.height ?? 0, 0] };
  const { diameter } = crown;
  const height = crown.height ?? diameter[Math.floor(diameter.length / 2)] - 0.5 * (diameter[0] + diameter[diameter.length - 1]);
  return { height: Number(height.toPrecision(6)), shape };
}

/** The box of a measured crown. */
export function crownTable(path, panel) {
  return panel.table({
    path: `${path}.crown`,
    label: say("face.crown-table"),
    columns: [
      { label: say("face.place"), dimension: "length" },
      { label: say("face.over-nominal"), dimension: "length" },
    ],
    read: (crown) => (crown.y ? rowsOf(CROWN, crown) : []),
    write: (rows) => (rows.length < 2 ? null : columnsOf(CROWN, rows)),
  });
}

/** Steps of a journal to begin with [mm]: two, the first as thick as half the core. */
export function stepsFor(roller) {
  const core = coreDiameter(roller);
  return [{ diameter: Number((0.6 * core).toPrecision(2)), length: 50 }, { diameter: Number((0.45 * core).toPrecision(2)) }];
}

/** The box of the steps of both journals. */
export function journalTable(path, panel) {
  return panel.table({
    path: `${path}.journals`,
    label: say("face.steps"),
    rows: 3,
    columns: [
      { label: say("face.step-diameter"), dimension: "length" },
      { label: say("face.step-length"), dimension: "length", isOptional: true },
    ],
    read: (steps) => steps.map(({ diameter, length }) => (length === undefined ? [diameter] : [diameter, length])),
    write: (rows) => rows.map(([diameter, length]) => (length === undefined ? { diameter } : { diameter, length })),
  });
}

/** The covering over the face: a box for it where it varies. */
export function coveringInputs(side, tree, panel, change) {
  const [layer] = tree[side].layers;
  if (!layer) return [];
  const path = `${side}.shaft.covering`;
  const has = tree[side].shaft.covering !== undefined;
  const half = tree.face.length / 2;
  const start = { y: [-half, half], thickness: [layer.thickness, layer.thickness] };
  const box = checkbox(`in-${side}-covering-varies`, say("face.covering-varies"), has, (yes) =>
    change(".covering", yes ? start : undefined),
  );
  if (!has) return [box];
  const stiffness = stiffnessOf(layer.material, panel.app);
  const table = panel.table({
    path,
    label: say("face.covering-table"),
    columns: [
      { label: say("face.place"), dimension: "length" },
      { label: say("face.covering-thickness"), dimension: "length" },
      { label: stiffness.label, dimension: stiffness.dimension, isOptional: true },
    ],
    read: (covering) => rowsOf(COVERING, whole(covering, layer)).map(([y, thickness, share]) => (share === undefined ? [y, thickness] : [y, thickness, stiffness.from(share)])),
    write: (rows) =>
      rows.length < 2 ? null : columnsOf(COVERING, rows.map(([y, thickness, value]) => [y, thickness, value === undefined ? undefined : stiffness.to(value)])),
  });
  return [box, table];
}

/** A covering of a case that gives the stiffness alone has the thickness of the layer everywhere. */
function whole(covering, { thickness }) {
  return covering.thickness ? covering : { ...covering, thickness: covering.y.map(() => thickness) };
}

/** How the stiffness over that of the material is typed: as hardness, as modulus, else in per cent. */
function stiffnessOf(material, app) {
  const share = (value) => Number(value.toPrecision(9)); // NaN where there is no such hardness
  if (kindOf(material) === "shore") {
    const usual = app.modulusOf(material.shore_a);
    return {
      label: say("input.shore"),
      dimension: "ratio",
      to: (shore) => share((modulusOf(shore, app.hardness)?.likely ?? NaN) / usual),
      from: (value) => hardnessOf(value * usual, app.hardness),
    };
  }
  if (material.model === "elastic" && material.modulus !== undefined) {
    const { modulus } = material;
    return { label: say("input.modulus"), dimension: "pressure", to: (value) => share(value / modulus), from: (value) => value * modulus };
  }
  return { label: say("face.covering-share"), dimension: "ratio", to: (value) => value / 100, from: (value) => 100 * value };
}

/** The hardness that has a modulus, to a tenth of a point. */
function hardnessOf(modulus, table) {
  let [low, high] = [table.shore_a[0], table.shore_a[table.shore_a.length - 1]];
  for (let turn = 0; turn < 40; turn += 1) {
    const middle = 0.5 * (low + high);
    if (modulusOf(middle, table).likely < modulus) low = middle;
    else high = middle;
  }
  return Math.round(10 * low) / 10;
}

