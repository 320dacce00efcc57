// The inputs along the face: its length, the shafts and crowns of both rollers.

import { SIDES, STEEL_DENSITY, endLoads, journalFor, withFace, withShaft, withoutFace } from "./face.js";
import { checkbox, el, select } from "./dom.js";
import { coveringInputs, crownAs, crownTable, journalTable, stepsFor } from "./facetables.js";
import { getAt, setAt } from "./paths.js";
import { say } from "./texts.js";

const ENDS = ["plane", "edge", "covering"];
const SHAPES = ["parabolic", "cosine", "circular", "table"];

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
        ...endInputs(tree, panel),
        ...offsetInputs(tree, panel),
        tree.sheet ? acrossChoice(tree, panel) : null,
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

/** How much further one bearing of the upper roller comes; forces at the bearings settle it themselves. */
function offsetInputs(tree, panel) {
  if (endLoads(tree) || !tree.upper.shaft) return [];
  const has = tree.face.bearing_offset !== undefined;
  const act = (yes) => panel.change(panel.withAt("face.bearing_offset", yes ? 0 : undefined));
  return [checkbox("in-has-offset", say("face.has-offset"), has, act), has ? panel.control("face.bearing_offset") : null];
}

/** What the nip does at the ends of the face. */
function endInputs(tree, panel) {
  const kind = tree.face.ends ?? ENDS[0];
  const act = (wanted) => {
    const { case: now } = panel.app.store.state;
    const { ends: _ends, end_radius: radius = 0, ...face } = now.face;
    const own = { plane: {}, edge: { ends: "edge", end_radius: radius }, covering: { ends: "covering" } };
    panel.change({ ...now, face: { ...face, ...own[wanted] } });
  };
  const options = ENDS.map((name) => [name, say(`face.ends-${name}`)]);
  return [
    select({ id: "in-face-ends", label: say("face.ends"), options, value: kind, act }),
    kind === "edge" ? panel.control("face.end_radius") : null,
  ];
}

/** How a sheet runs across its width. */
function acrossChoice(tree, panel) {
  return select({
    id: "in-sheet-across",
    label: say("face.sheet-across"),
    options: ["free", "one-speed"].map((kind) => [kind, say(`face.sheet-${kind}`)]),
    value: tree.face.sheet_across ?? "free",
    act: (kind) => panel.change(panel.withAt("face.sheet_across", kind)),
  });
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
  const isHeld = side === "upper" && Boolean(endLoads(tree)); // forces at its bearings
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
    const { journal_diameter: _one, journals: _steps, ...rest } = now[side].shaft;
    const own = {
      rigid: {},
      round: { journal_diameter: journalFor(now[side], view.system) },
      steps: { journals: stepsFor(now[side]) },
    };
    change("", { ...rest, ...own[kind] });
  };
  const hasHeight = typeof getAt(shaft, "crown.height") === "number";
  const isTable = Boolean(shaft.crown.y);
  const kind = shaft.journals?.length ? "steps" : shaft.journal_diameter === undefined ? "rigid" : "round";
  return [
    hasHeight ? panel.control(`${path}.crown.height`) : null,
    hasHeight || isTable
      ? select({
          id: `in-${side}-crown-shape`,
          label: say("face.shape"),
          options: SHAPES.map((shape) => [shape, say(`face.${shape}`)]),
          value: isTable ? "table" : shaft.crown.shape,
          act: (shape) => {
            const { case: now } = panel.app.store.state;
            change(".crown", crownAs(shape, now[side].shaft.crown, now.face.length));
          },
        })
      : null,
    isTable ? crownTable(path, panel) : null,
    panel.control(`${path}.bearing_distance`),
    panel.control(`${path}.bore`),
    select({
      id: `in-${side}-journals`,
      label: say("face.journals"),
      options: [
        ["round", say("face.journals-round")],
        ["steps", say("face.journals-steps")],
        ["rigid", say("face.journals-rigid")],
      ],
      value: kind,
      act: journals,
    }),
    kind === "round" ? panel.control(`${path}.journal_diameter`) : null,
    kind === "steps" ? journalTable(path, panel) : null,
    ...coveringInputs(side, tree, panel, change),
    panel.fold(`in-${side}-shaft-more`, say("face.more"), [
      panel.control(`${path}.bearing_middle`),
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
