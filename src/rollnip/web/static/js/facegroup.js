// The inputs along the face: its length, the shafts and crowns of both rollers.

import { SIDES, STEEL_DENSITY, journalFor, withFace, withShaft, withoutFace } from "./face.js";
import { checkbox, el, select } from "./dom.js";
import { getAt, setAt } from "./paths.js";
import { say } from "./texts.js";

const SHAPES = ["parabolic", "cosine", "circular"];

/** The group of inputs; `panel` is the Inputs it stands in. */
export function faceGroup(tree, panel) {
  const { store } = panel.app;
  const act = (yes) => {
    const { case: now, view } = store.state;
    panel.change(yes ? withFace(now, view.system) : withoutFace(now));
    if (yes) store.view({ tab: "face" });
  };
  const whole = tree.face
    ? [
        panel.control("face.length"),
        panel.control("face.skew"),
        ...SIDES.map((side) => shaftCard(side, tree, panel)),
      ]
    : [el("p", { class: "hint", text: say("face.hint") })];
  return el(
    "fieldset",
    { class: "group", id: "group-face" },
    el("legend", { text: say("face.title") }),
    checkbox("in-has-face", say("face.has"), Boolean(tree.face), act),
    ...whole,
  );
}

function shaftCard(side, tree, panel) {
  const { radius, shaft } = tree[side];
  if (radius === "inf") return null;
  const path = `${side}.shaft`;
  const change = (key, value) => panel.change(setAt(panel.app.store.state.case, `${path}${key}`, value));
  const bends = (yes) => {
    const { case: now, view } = panel.app.store.state;
    if (yes) panel.change(withShaft(now, side, view.system));
    else change("", undefined);
  };
  const isHeld = side === "upper" && Boolean(tree.face.end_loads); // forces at its bearings
  const box = checkbox(`in-${side}-has-shaft`, say(`face.bends-${side}`), Boolean(shaft), bends);
  box.querySelector("input").disabled = isHeld;
  const label = say(`roller.${side}`);
  return el(
    "div",
    { class: "layer", role: "group", "aria-label": label },
    el("h3", { text: label }),
    box,
    ...(shaft ? shaftInputs(side, tree, panel, change) : []),
  );
}

function shaftInputs(side, tree, panel, change) {
  const { shaft } = tree[side];
  const path = `${side}.shaft`;
  const journals = (kind) => {
    const { case: now, view } = panel.app.store.state;
    change(".journal_diameter", kind === "rigid" ? undefined : journalFor(now[side], view.system));
  };
  const hasHeight = typeof getAt(shaft, "crown.height") === "number";
  return [
    hasHeight ? panel.control(`${path}.crown.height`) : null,
    hasHeight
      ? select({
          id: `in-${side}-crown-shape`,
          label: say("face.shape"),
          options: SHAPES.map((shape) => [shape, say(`face.${shape}`)]),
          value: shaft.crown.shape,
          act: (shape) => change(".crown.shape", shape),
        })
      : null,
    panel.control(`${path}.bearing_distance`),
    panel.control(`${path}.bore`),
    select({
      id: `in-${side}-journals`,
      label: say("face.journals"),
      options: [
        ["round", say("face.journals-round")],
        ["rigid", say("face.journals-rigid")],
      ],
      value: shaft.journal_diameter === undefined ? "rigid" : "round",
      act: journals,
    }),
    shaft.journal_diameter === undefined ? null : panel.control(`${path}.journal_diameter`),
    panel.fold(`in-${side}-shaft-more`, say("face.more"), [
      panel.control(`${path}.modulus`),
      checkbox(`in-${side}-weighs`, say("face.weighs"), shaft.density !== undefined, (yes) =>
        change(".density", yes ? STEEL_DENSITY : undefined),
      ),
      shaft.density === undefined ? null : panel.control(`${path}.density`),
      shaft.density === undefined || tree.face.nip_angle === undefined
        ? null
        : panel.control("face.nip_angle"),
    ]),
  ];
}
