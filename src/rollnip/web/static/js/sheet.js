// A sheet between the rollers: its inputs, and what a design holds of it.

import { checkbox, el, select } from "./dom.js";
import { SHEETS } from "./figures.js";
import { getAt, setAt } from "./paths.js";
import { say, sayOr } from "./texts.js";

const STUFF = ["thickness", "modulus", "poisson", "modulus_thickness"];
const FIRST = "office paper";
const OWN = "own";

/** Paths of the numbers of the sheet of a design. */
export function sheetPaths(tree) {
  const names = [...STUFF, "tension_in", "tension_out", "friction_upper", "friction_lower"];
  return names.map((name) => `sheet.${name}`).filter((path) => typeof getAt(tree, path) === "number");
}

/** The sheet of a case as the page holds it: values of a usual sheet instead of its name. */
export function sheetOf({ kind, ...own }) {
  return { tension_in: 0, tension_out: 0, ...usual(kind), ...own };
}

function usual(name) {
  const found = SHEETS.find((one) => one.name === name);
  return found ? found.sheet : {};
}

/** The usual sheet that one is, by name; "own" where it is none. */
function kindOf(sheet) {
  const isSame = (one) => STUFF.every((key) => (one[key] ?? null) === (sheet[key] ?? null));
  return SHEETS.find((one) => isSame(one.sheet))?.name ?? OWN;
}

/** The group of inputs; `panel` is the Inputs it stands in. */
export function sheetGroup(tree, panel) {
  const { sheet } = tree;
  const put = (value) => panel.change(setAt(panel.app.store.state.case, "sheet", value));
  const has = checkbox("in-has-sheet", say("sheet.has"), Boolean(sheet), (yes) =>
    put(yes ? sheetOf({ kind: FIRST }) : undefined),
  );
  return el(
    "fieldset",
    { class: "group", id: "group-sheet" },
    el("legend", { text: say("sheet.title") }),
    has,
    ...(sheet ? sheetInputs(panel, put) : [el("p", { class: "hint", text: say("sheet.hint") })]),
  );
}

function sheetInputs(panel, put) {
  const { sheet } = panel.app.store.state.case;
  const own = (yes) => {
    const { sheet: now, nip } = panel.app.store.state.case;
    const { friction_upper: _u, friction_lower: _l, ...rest } = now;
    put(yes ? { ...rest, friction_upper: nip.friction, friction_lower: nip.friction } : rest);
  };
  const hasOwn = sheet.friction_upper !== undefined || sheet.friction_lower !== undefined;
  const more = ["poisson", "modulus_thickness"].filter((name) => sheet[name] !== undefined);
  const frictions = ["friction_upper", "friction_lower"].filter((name) => sheet[name] !== undefined);
  return [
    kinds(panel, put),
    ...["thickness", "modulus", "tension_in", "tension_out"].map((name) => panel.control(`sheet.${name}`)),
    panel.fold("in-sheet-more", say("sheet.more"), [
      ...more.map((name) => panel.control(`sheet.${name}`)),
      checkbox("in-sheet-friction", say("sheet.own-friction"), hasOwn, own),
      ...frictions.map((name) => panel.control(`sheet.${name}`)),
      bending(panel, put),
      el("p", { class: "hint", id: "in-sheet-bending-hint", text: say("hint.sheet-bending") }),
    ]),
  ];
}

/** Whether the stiffness of the sheet against bending is counted: where it shows, always, never. */
function bending(panel, put) {
  const options = [
    ["auto", say("sheet.bending-auto")],
    ["on", say("sheet.bending-on")],
    ["off", say("sheet.bending-off")],
  ];
  const valueOf = (sheet) => (sheet.bending === undefined ? "auto" : sheet.bending ? "on" : "off");
  const act = (value) => {
    const { bending: _before, ...rest } = panel.app.store.state.case.sheet;
    put(value === "auto" ? rest : { ...rest, bending: value === "on" });
  };
  const { sheet } = panel.app.store.state.case;
  const box = { id: "in-sheet-bending", label: say("sheet.bending"), options, value: valueOf(sheet), act };
  const chosen = select(box);
  chosen.querySelector("select").setAttribute("aria-describedby", "in-sheet-bending-hint");
  panel.parts.push({
    refresh: ({ sheet: now }) => {
      if (now) chosen.querySelector("select").value = valueOf(now);
    },
  });
  return chosen;
}

/** The choice of a usual sheet; a slider may make another one of it. */
function kinds(panel, put) {
  const options = [
    ...SHEETS.map(({ name }) => [name, sayOr(`sheet.kind.${name}`, name)]),
    [OWN, say("sheet.own")],
  ];
  const act = (name) => {
    if (name === OWN) return;
    const { modulus_thickness: _across, ...now } = panel.app.store.state.case.sheet;
    put({ ...now, ...usual(name) });
  };
  const chosen = select({ id: "in-sheet-kind", label: say("sheet.kind"), options, value: OWN, act });
  const refresh = ({ sheet }) => {
    if (sheet) chosen.querySelector("select").value = kindOf(sheet);
  };
  panel.parts.push({ refresh });
  refresh(panel.app.store.state.case);
  return chosen;
}
