// The inputs of a patch: how it is pressed and driven, and both rollers across the rolling direction.

import { Control } from "./control.js";
import { checkbox, el, select } from "./dom.js";
import {
  ACCURACIES,
  SIDES,
  exchanged,
  patchDrive,
  patchPress,
  shapeAcross,
  withEnds,
  withShape,
} from "./patch.js";
import { getAt, setAt } from "./paths.js";
import { say } from "./texts.js";
import { number } from "./units.js";

const CREEP = { dimension: "share", low: -0.03, high: 0.03 };
const NIP = {
  load: { dimension: "roller force", low: 1, high: 100000, log: true },
  approach: { dimension: "length", low: 0.005, high: 8, log: true },
  creepage: CREEP,
  lateral_creepage: CREEP,
  spin: { dimension: "turn per length", low: -0.05, high: 0.05 },
};
const ROLLER = {
  lateral_radius: { dimension: "length", low: 5, high: 20000, log: true },
  face: { dimension: "length", low: 2, high: 1000, log: true },
  end_radius: { dimension: "length", low: 0, high: 50 },
};
const HINTED = ["spin", "traction", "creepage", "lateral_creepage"];

/** A control of a number of the patch: the paths are those of its case. */
export class PatchControl extends Control {
  constructor(path, app) {
    super(`patch.${path}`, app);
  }

  get inside() {
    return this.path.slice("patch.".length);
  }

  get input() {
    const [part, name] = this.inside.split(".");
    const hint = HINTED.includes(name) ? say(`patch.${name}-hint`) : null;
    const label = say(`patch.${name}`);
    if (part !== "nip") return { path: this.path, label, hint: null, factor: this.sign, ...ROLLER[name] };
    return { path: this.path, label, hint, factor: 1, ...(NIP[name] ?? this.force) };
  }

  /** A hollow roller has a negative radius across; its size is shown. */
  get sign() {
    return getAt(this.app.store.state.patch, this.inside) < 0 ? -1 : 1;
  }

  /** A traction may be as large as friction allows. */
  get force() {
    const { case: tree, patch } = this.app.store.state;
    const most = Number((0.98 * tree.nip.friction * (patch.nip.load ?? 1000)).toPrecision(3)) || 1;
    return { dimension: "roller force", low: -most, high: most };
  }

  valueIn() {
    const { patch } = this.app.store.state;
    return patch ? getAt(patch, this.inside) : undefined;
  }

  set(value, gesture) {
    this.sent = gesture === null ? null : value;
    const { patch } = this.app.store.state;
    this.app.store.design({ patch: setAt(patch, this.inside, value) }, gesture);
  }
}

/** The groups of inputs of the patch at hand: {nodes, controls}. */
export function patchInputs(app, result) {
  const controls = [];
  const control = (path) => {
    const one = new PatchControl(path, app);
    controls.push(one);
    return one.node;
  };
  const nodes = [pressed(app, result, control), driven(app, result, control), ...SIDES.map((side) => across(side, app, control))];
  return { nodes, controls };
}

function put(app, patch) {
  app.store.design({ patch });
}

function group(title, ...children) {
  const isLong = children.length > 4;
  return el("div", { class: isLong ? "patch-group long" : "patch-group", role: "group", "aria-label": title }, el("h3", { text: title }), ...children);
}

function pressed(app, result, control) {
  const { patch } = app.store.state;
  const kind = patchPress(patch);
  const accuracy = ACCURACIES.map((share) => [String(share), say("patch.within", { share: number(100 * share) })]);
  return group(
    say("patch.pressed"),
    choice("press", ["load", "approach"], kind, (wanted) => {
      const usual = wanted === "load" ? 500 : 0.3;
      put(app, exchanged(app.store.state.patch, kind, wanted, result()?.patch[wanted] ?? usual));
    }),
    control(`nip.${kind}`),
    select({
      id: "patch-accuracy",
      label: say("patch.accuracy"),
      options: accuracy,
      value: String(patch.tolerance),
      act: (share) => put(app, { ...app.store.state.patch, tolerance: Number(share) }),
    }),
  );
}

function driven(app, result, control) {
  const drive = (isAcross) => {
    const [before, answer] = isAcross ? ["lateral_", "traction_y"] : ["", "traction_x"];
    const kind = patchDrive(app.store.state.patch, isAcross);
    const act = (wanted) => {
      const now = result()?.patch;
      const value = wanted === "traction" ? now?.[answer] : now?.[`${before}creepage`];
      put(app, exchanged(app.store.state.patch, before + kind, before + wanted, value ?? 0));
    };
    return [choice(isAcross ? "across" : "along", ["traction", "creepage"], kind, act), control(`nip.${before}${kind}`)];
  };
  return group(say("patch.driven"), ...drive(false), ...drive(true), control("nip.spin"));
}

/** A choice between kinds; its name is part of the ids and messages. */
function choice(name, kinds, value, act) {
  return select({
    id: `patch-${name}`,
    label: say(`patch.by-${name}`),
    options: kinds.map((kind) => [kind, say(`patch.by-${name}-${kind}`)]),
    value,
    act,
  });
}

function across(side, app, control) {
  const { patch, view } = app.store.state;
  const shape = shapeAcross(patch, side);
  const hasEnds = patch[side].face !== undefined;
  return group(
    say(`roller.${side}`),
    select({
      id: `patch-${side}-shape`,
      label: say("patch.shape"),
      options: ["straight", "crowned", "hollow"].map((kind) => [kind, say(`patch.${kind}`)]),
      value: shape,
      act: (kind) => put(app, withShape(app.store.state.patch, side, kind, view.system)),
    }),
    shape === "straight" ? null : control(`${side}.lateral_radius`),
    checkbox(`patch-${side}-ends`, say("patch.ends"), hasEnds, (yes) =>
      put(app, withEnds(app.store.state.patch, side, yes, app.store.state.view.system)),
    ),
    ...(hasEnds ? [control(`${side}.face`), control(`${side}.end_radius`)] : []),
  );
}
