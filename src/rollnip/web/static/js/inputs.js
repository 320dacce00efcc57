// The column of inputs. It is built anew only where the shape of a design changes.

import { driveBy, driving } from "./design.js";
import { checkbox, el, select } from "./dom.js";
import { faceGroup } from "./facegroup.js";
import { Control } from "./control.js";
import { heated } from "./heat.js";
import { heatGroup } from "./heatgroup.js";
import { idOf, setAt } from "./paths.js";
import { choosePress, pressControls, pressKind, pressKinds } from "./press.js";
import { coreEditor, rollerGroup, swapper } from "./rollers.js";
import { sheetGroup } from "./sheet.js";
import { TableBox } from "./tablebox.js";
import { say } from "./texts.js";

const GEOMETRIES = [
  ["finite", say("geometries.finite")],
  ["second", say("geometry.second")],
  ["curved", say("geometry.curved")],
  ["corrected", say("geometry.corrected")],
  ["linear", say("geometry.linear")],
];
const DRIVES = [
  ["free", say("drives.free")],
  ["idler", say("drives.idler")],
  ["traction", say("drives.traction")],
  ["creepage", say("drives.creepage")],
  ["torque", say("drives.torque")],
];

/** The panel of inputs inside `place`. */
export class Inputs {
  constructor(place, app) {
    this.place = place;
    this.app = app;
    this.open = new Set();
    this.controls = [];
    this.parts = []; // what else follows a design: {refresh(tree)}
    this.rebuild();
    app.store.listen((state) => this.refresh(state));
  }

  refresh(state) {
    if (this.shapeOf(state.case) !== this.shape) this.rebuild();
    else for (const part of [...this.controls, ...this.parts]) part.refresh(state.case);
  }

  /** What must be the same for the panel to stay as it is. */
  shapeOf(tree) {
    return `${shapeOf(tree)} ${pressKind(this.app)}`;
  }

  /** Everything anew; focus and open folds stay where they are. */
  rebuild() {
    const tree = this.app.store.state.case;
    const focused = document.activeElement?.id;
    this.open = new Set(Array.from(this.place.querySelectorAll("details[open]"), ({ id }) => id));
    this.controls = [];
    this.parts = [];
    this.shape = this.shapeOf(tree);
    this.place.replaceChildren(
      rollerGroup("upper", tree, this),
      swapper(this),
      rollerGroup("lower", tree, this),
      this.pressingGroup(tree),
      this.runningGroup(tree),
      sheetGroup(tree, this),
      faceGroup(tree, this),
      heatGroup(tree, this),
      this.advancedGroup(tree),
    );
    if (focused && document.activeElement?.id !== focused) document.getElementById(focused)?.focus();
  }

  /** A control of the number at a path. */
  control(path) {
    const control = new Control(path, this.app);
    this.controls.push(control);
    return control.node;
  }

  /** A table of numbers in a text box. */
  table(options) {
    const box = new TableBox(options, this);
    this.controls.push(box);
    return box.node;
  }

  /** The design at hand with a value at a path. */
  withAt(path, value) {
    return setAt(this.app.store.state.case, path, value);
  }

  /** A fold that stays open over a rebuild. */
  fold(id, title, children, kind = "fold") {
    const inner = el("div", { class: "inner" }, ...children);
    return el(
      "details",
      { class: kind, id, open: this.open.has(id) },
      el("summary", { text: title }),
      inner,
    );
  }

  /** Take a design; what a heat balance needs besides has usual values. */
  change(tree) {
    this.app.store.design({ case: heated(tree) });
  }

  /** Show what the server found wrong at the controls it belongs to. */
  complain(details) {
    for (const control of this.controls) {
      control.refuse(details.find(({ path }) => path === control.path)?.message ?? "");
    }
  }

  /** Whether a box holds what nobody can read. */
  isUnread() {
    return this.controls.some((control) => control.isUnread && control.node.isConnected);
  }

  pressingGroup(tree) {
    const kind = pressKind(this.app);
    return group(
      say("group.press"),
      choices("press", say("press.by"), pressKinds(tree), kind, (value) => choosePress(this.app, value)),
      ...pressControls(kind, this),
    );
  }

  runningGroup(tree) {
    const kind = driving(tree);
    const own = { traction: "nip.traction", creepage: "nip.creepage", torque: "nip.torque_lower" }[kind];
    const options = DRIVES.filter(([value]) => value !== "torque" || kind === "torque");
    const choose = (value) => this.change(driveBy(this.app.store.state.case, value, this.app.result()));
    return group(
      say("group.run"),
      tree.nip.speed === undefined ? this.addSpeed() : this.control("nip.speed"),
      select({ id: "in-drive", label: say("drive.label"), options, value: kind, act: choose }),
      own ? this.control(own) : null,
      this.control("nip.friction"),
    );
  }

  addSpeed() {
    const act = () => this.change(setAt(this.app.store.state.case, "nip.speed", 1000));
    return el("button", {
      type: "button",
      class: "button",
      id: "add-speed",
      text: say("speed.give"),
      on: { click: act },
    });
  }

  advancedGroup(tree) {
    const geometry = (value) => this.change(setAt(this.app.store.state.case, "model.geometry", value));
    const width = (yes) =>
      this.change(setAt(this.app.store.state.case, "nip.face_width", yes ? 1000 : undefined));
    const hasWidth = tree.nip.face_width !== undefined;
    const isWhole = ["force", "cylinders"].includes(pressKind(this.app));
    return this.fold(
      "advanced",
      say("group.advanced"),
      [
        select({
          id: "in-geometry",
          label: say("geometry.label"),
          options: GEOMETRIES,
          value: tree.model.geometry,
          act: geometry,
        }),
        el("p", { class: "note", text: say("geometry.note") }),
        isWhole || tree.face ? null : checkbox("in-has-width", say("face.totals"), hasWidth, width),
        hasWidth && !isWhole && !tree.face ? this.control("nip.face_width") : null,
        ...["upper", "lower"].flatMap((side) => [coreEditor(side, tree, this), this.planeBox(side, tree)]),
      ],
      "group",
    );
  }

  planeBox(side, tree) {
    const act = (yes) => this.change(setAt(this.app.store.state.case, `${side}.radius`, yes ? "inf" : 100));
    const other = side === "upper" ? "lower" : "upper";
    if (tree[other].radius === "inf") return null;
    return checkbox(
      `in-${side}-plane`,
      say("body.is-plane", { side: say(`side.${side}`) }),
      tree[side].radius === "inf",
      act,
    );
  }
}

/** What must be the same for the panel to stay as it is: everything but the numbers. */
function shapeOf(tree) {
  const shape = JSON.stringify(tree, (key, value) =>
    key === "title" || typeof value === "number" ? 0 : value,
  );
  return `${shape} ${driving(tree)}`;
}

function group(title, ...children) {
  return el("fieldset", { class: "group" }, el("legend", { text: title }), ...children);
}

/** A choice of two or three, as radio buttons. */
export function choices(name, label, options, value, act) {
  const buttons = options.map(([key, text]) => {
    const radio = el("input", {
      type: "radio",
      name,
      id: idOf(`${name}.${key}`),
      value: key,
      on: { change: () => act(key) },
    });
    radio.checked = key === value;
    return el("label", {}, radio, text);
  });
  return el("div", { class: "choices", role: "radiogroup", "aria-label": label }, ...buttons);
}
