// What presses the rollers together: a line load, an approach, a force, or cylinders.

import { Control } from "./control.js";
import { pressBy, pressing, withSize } from "./design.js";
import { byArms, byEndLoads, endLoads } from "./face.js";
import { rowsEditor } from "./rows.js";
import { el } from "./dom.js";
import { setAt } from "./paths.js";
import { say } from "./texts.js";

const FACE = { metric: 1000, us: 1016 }; // mm, 40 in
const RANGES = {
  force: { dimension: "roller force", low: 10, high: 500000, log: true },
  pressure: { dimension: "air pressure", low: 0.01, high: 20, log: true },
  bore: { dimension: "length", low: 10, high: 400, log: true },
  count: { dimension: "ratio", low: 1, high: 8 },
  ratio: { dimension: "ratio", low: 0.1, high: 10, log: true },
};
const CYLINDERS = ["pressure", "bore", "count", "ratio"];

/** "load", "approach", "force" or "cylinders". */
export function pressKind(app) {
  const { case: tree, view } = app.store.state;
  if (tree.face?.arms) return "arms";
  if (tree.face?.end_loads) return "ends";
  if (pressing(tree) === "approach") return "approach";
  const isWhole = view.press !== "load" && tree.nip.face_width !== undefined;
  return isWhole ? view.press : "load";
}

/** The kinds of pressing as [key, text]; forces at the ends need bearings. */
export function pressKinds(tree) {
  const ends = tree.face && tree.upper.shaft ? ["ends", "arms"] : [];
  return ["load", "approach", "force", "cylinders", ...ends].map((key) => [key, say(`press.${key}`)]);
}

/** Take another kind of pressing; the nip stays as it is. */
export function choosePress(app, kind) {
  const { store } = app;
  store.state = { ...store.state, view: { ...store.state.view, press: kind } };
  const wanted = kind === "approach" ? "approach" : "load";
  const { case: now } = store.state;
  const load = app.result()?.load ?? now.nip.load;
  if (kind === "ends") return store.design({ case: byEndLoads(now, load) });
  if (kind === "arms") return store.design({ case: byArms(now, load) });
  const isThere = pressing(now) === wanted && !endLoads(now);
  const tree = isThere ? now : pressBy(now, wanted, app.result());
  const isWhole = kind === "force" || kind === "cylinders";
  const face = tree.nip.face_width ?? (isWhole ? (tree.face?.length ?? FACE[store.state.view.system]) : undefined);
  return store.design({ case: setAt(tree, "nip.face_width", face) });
}

/** The controls of a kind of pressing. */
export function pressControls(kind, panel) {
  if (kind === "load" || kind === "approach") return [panel.control(`nip.${kind}`)];
  if (kind === "ends") return [0, 1].map((end) => panel.control(`face.end_loads[${end}]`));
  if (kind === "arms") return [0, 1].map((end) => armInputs(end, panel));
  const names = kind === "force" ? ["force"] : CYLINDERS;
  const controls = names.map((name) => new PressControl(name, panel.app));
  const face = new FaceControl("nip.face_width", panel.app);
  panel.controls.push(...controls, face);
  return [...controls, face].map(({ node }) => node);
}

/** One arm: how far the bearing is from its pivot, and the forces on it. */
function armInputs(end, panel) {
  const path = `face.arms[${end}]`;
  const label = say(`face.arm-${end}`);
  const forces = { kind: "force", names: ["force", "lever"], fewest: 1, next: (last) => ({ ...last }) };
  return el(
    "div",
    { class: "layer", role: "group", "aria-label": label },
    el("h3", { text: label }),
    panel.control(`${path}.bearing_lever`),
    rowsEditor(`${path}.forces`, forces, panel),
  );
}

/** Area of all cylinders times their lever [mm2]. */
function lever({ bore, count, ratio }) {
  return 0.25 * Math.PI * bore * bore * count * ratio;
}

/** A control of what makes the line load: the force is line load times face width. */
export class PressControl extends Control {
  constructor(name, app) {
    super(`press.value.${name}`, app);
  }

  get name() {
    return this.path.split(".")[2];
  }

  get input() {
    const name = this.path.split(".")[2];
    const hint = ["force", "pressure", "ratio"].includes(name) ? say(`press.${name}-hint`) : null;
    return { path: this.path, factor: 1, label: say(`press.${name}-label`), hint, ...RANGES[name] };
  }

  valueIn(tree) {
    const { machine } = this.app.store.state.view;
    const name = this.path.split(".")[2];
    const force = tree.nip.load * tree.nip.face_width;
    if (name === "force") return force;
    return name === "pressure" ? force / lever(machine) : machine[name];
  }

  treeWith(value) {
    const { store } = this.app;
    const { case: tree, view } = store.state;
    const face = tree.nip.face_width;
    if (this.name === "force") return setAt(tree, "nip.load", value / face);
    if (this.name === "pressure") return setAt(tree, "nip.load", (value * lever(view.machine)) / face);
    const machine = { ...view.machine, [this.name]: value };
    const pressure = (tree.nip.load * face) / lever(view.machine);
    store.state = { ...store.state, view: { ...view, machine } };
    return setAt(tree, "nip.load", (pressure * lever(machine)) / face);
  }
}

/** The face width where a force is given: the force stays. */
class FaceControl extends Control {
  treeWith(value) {
    const tree = this.app.store.state.case;
    const force = tree.nip.load * tree.nip.face_width;
    return setAt(withSize(tree, this.path, value), "nip.load", force / value);
  }
}
