// The inputs of heat: ambient air, films, cores, thermal properties.

import { checkbox, el, select } from "./dom.js";
import { CORES, METALS, OWN, USUAL, coreKind, materialsOf, withHeat, withoutHeat } from "./heat.js";
import { getAt, idOf, setAt } from "./paths.js";
import { say } from "./texts.js";

const SIDES = ["upper", "lower"];
const MEASURED = { conductivity: 0.25, density: 1150, heat_capacity: 1700, expansion: 0.00018 };
const SHELL = { thickness: 10, thermal: "steel" };

/** The group of inputs; `panel` is the Inputs it stands in. */
export function heatGroup(tree, panel) {
  const { store } = panel.app;
  const act = (yes) => {
    const { case: now } = store.state;
    panel.change(yes ? withHeat(now) : withoutHeat(now));
    if (yes) store.view({ tab: "heat" });
  };
  const whole = tree.heat
    ? [
        panel.control("heat.ambient"),
        ...starts(tree, panel),
        ...SIDES.map((side) => rollerCard(side, tree, panel)),
        tree.heat.sheet ? sheetCard(tree, panel) : null,
      ]
    : [el("p", { class: "hint", text: say("heat.hint") })];
  return el(
    "fieldset",
    { class: "group", id: "group-heat" },
    el("legend", { text: say("heat.title") }),
    checkbox("in-has-heat", say("heat.has"), Boolean(tree.heat), act),
    ...whole,
  );
}

function put(panel, path, value) {
  panel.change(setAt(panel.app.store.state.case, path, value));
}

/** Where a warm-up begins, if not at the ambient temperature. */
function starts(tree, panel) {
  const own = tree.heat.start !== undefined;
  const act = (yes) => put(panel, "heat.start", yes ? tree.heat.ambient : undefined);
  return [checkbox("in-heat-has-start", say("heat.has-start"), own, act), own ? panel.control("heat.start") : null];
}

function rollerCard(side, tree, panel) {
  const label = say(tree[side].radius === "inf" ? `body.${side}-plane` : `roller.${side}`);
  const materials = materialsOf(side, tree).map((path) => properties(path, side, tree, panel, USUAL));
  const cooling = tree[side].radius === "inf" ? [] : coolingInputs(side, tree, panel);
  if (materials.length + cooling.length === 0) return null;
  return el(
    "div",
    { class: "layer", role: "group", "aria-label": label },
    el("h3", { text: label }),
    ...cooling,
    ...materials.flat(),
  );
}

function coolingInputs(side, tree, panel) {
  const path = `${side}.heat`;
  const { heat } = tree[side];
  if (!heat) return [];
  const kind = coreKind(heat);
  const core = { insulated: [], held: ["core"], cooled: ["core.coolant", "core.film"] }[kind];
  const shell = (yes) => put(panel, `${path}.shell`, yes ? { ...SHELL } : undefined);
  return [
    panel.control(`${path}.film`),
    select({
      id: `in-${side}-heat-core-kind`,
      label: say("heat.core"),
      options: Object.keys(CORES).map((name) => [name, say(`heat.core-${name}`)]),
      value: kind,
      act: (name) => put(panel, `${path}.core`, CORES[name]),
    }),
    ...core.map((name) => panel.control(`${path}.${name}`)),
    tree[side].core ? null : checkbox(`in-${side}-has-shell`, say("heat.has-shell"), Boolean(heat.shell), shell),
    heat.shell ? panel.control(`${path}.shell.thickness`) : null,
    ...(heat.shell ? properties(`${path}.shell`, side, tree, panel, METALS) : []),
  ];
}

function sheetCard(tree, panel) {
  return el(
    "div",
    { class: "layer", role: "group", "aria-label": say("sheet.title") },
    el("h3", { text: say("sheet.title") }),
    panel.control("heat.sheet.temperature"),
    ...properties("heat.sheet", "sheet", tree, panel, USUAL),
  );
}

/** The thermal properties at a path: usual ones by name, or own numbers. */
function properties(path, side, tree, panel, names) {
  const { thermal, ...now } = getAt(tree, path);
  const act = (name) => {
    const { case: last } = panel.app.store.state;
    const table = getAt(last, path);
    const { thermal: _name, conductivity: _k, density: _d, heat_capacity: _c, expansion: _a, ...rest } = table;
    put(panel, path, name === OWN ? { ...rest, ...MEASURED } : { ...rest, thermal: name });
  };
  const isOwn = now.conductivity !== undefined;
  const value = isOwn ? OWN : thermal;
  const known = names.includes(thermal) || isOwn ? names : [thermal, ...names];
  const options = [...known.map((name) => [name, say(`thermal.${name}`)]), [OWN, say("thermal.own")]];
  const numbers = isOwn ? Object.keys(MEASURED).filter((name) => now[name] !== undefined) : [];
  const index = path.match(/layers\[(\d+)\]/)?.[1];
  const which = placeOf(path, side, index, tree);
  return [
    select({ id: `${idOf(path)}-thermal`, label: which, options, value, act }),
    ...numbers.map((name) => panel.control(`${path}.${name}`)),
  ];
}

function placeOf(path, side, index, tree) {
  if (path.endsWith(".shell")) return say("heat.of-shell");
  if (path === "heat.sheet") return say("heat.of-sheet");
  if (index === undefined) return say("heat.of-core");
  return tree[side].layers.length > 1
    ? say("heat.of-layer", { number: Number(index) + 1 })
    : say("heat.of-covering");
}
