// One roller: its diameter, and its layers from the surface to the core.

import { RIGID, RUBBER, swapped, withLayers } from "./design.js";
import { button, el, select } from "./dom.js";
import { icon } from "./icons.js";
import { materialEditor } from "./materials.js";
import { setAt } from "./paths.js";
import { toneOf } from "./palette.js";
import { say } from "./texts.js";

const MOST_LAYERS = 20;

/** The group of a roller; `panel` is the Inputs it stands in. */
export function rollerGroup(side, tree, panel) {
  const { layers } = tree[side];
  const title = side === "upper" ? say("roller.upper") : say("roller.lower");
  const isPlane = tree[side].radius === "inf";
  return el(
    "fieldset",
    { class: "group", id: `group-${side}` },
    el("legend", { text: isPlane ? say(`body.${side}-plane`) : title }),
    isPlane ? null : panel.control(`${side}.radius`),
    ...layers.map((layer, i) => layerCard(side, i, tree, panel)),
    layers.length && !isPlane ? keeper(side, panel) : null,
    adder(side, layers, panel),
  );
}

/** The button that puts the covering of each roller on the other one. */
export function swapper(panel) {
  const swap = () => panel.change(swapped(panel.app.store.state.case));
  const content = el("span", {}, icon("swap"), ` ${say("roller.swap")}`);
  return el("div", { class: "row swap" }, button(content, swap, { kind: "small", id: "swap" }));
}

/** What stays when a thickness changes: the diameter over the covering, or the core. */
function keeper(side, panel) {
  const { store } = panel.app;
  const act = (what) => store.view({ keeps: { ...store.state.view.keeps, [side]: what } });
  const chosen = select({
    id: `in-${side}-keeps`,
    label: say("roller.keeps"),
    options: [
      ["diameter", say("roller.keeps-diameter")],
      ["core", say("roller.keeps-core")],
    ],
    value: store.state.view.keeps[side],
    act,
  });
  const note = el("p", { class: "note", id: `${side}-core` });
  const refresh = (tree) => {
    const { radius, layers } = tree[side];
    const core = 2 * layers.reduce((rest, { thickness }) => rest - thickness, radius);
    chosen.querySelector("select").value = store.state.view.keeps[side];
    note.textContent = core > 0 ? say("roller.core", { size: panel.app.units().text(core, "length") }) : "";
  };
  panel.parts.push({ refresh });
  refresh(store.state.case);
  chosen.append(note);
  return chosen;
}

function adder(side, layers, panel) {
  const add = () => {
    const like = layers[layers.length - 1];
    const layer = like ? structuredClone(like) : { thickness: 10, material: { ...RUBBER } };
    change(panel, side, (list) => list.push(layer));
  };
  const text = layers.length ? say("roller.add-layer") : say("roller.add");
  const disabled = layers.length >= MOST_LAYERS;
  return el(
    "div",
    { class: layers.length ? "row" : "row bare" },
    layers.length ? null : el("span", { text: say("roller.bare") }),
    button(text, add, { kind: "small", id: `add-${side}`, disabled }),
  );
}

function layerCard(side, i, tree, panel) {
  const { layers } = tree[side];
  const path = `${side}.layers[${i}]`;
  const called = layers.length === 1 ? say("roller.covering") : say(i === 0 ? "roller.first-layer" : "roller.layer", { number: i + 1 });
  const swatch = el("span", { class: "swatch", "data-tone": `${side} ${i}` });
  swatch.style.background = toneOf(side, i, panel.app.palette());
  return el(
    "div",
    { class: "layer", role: "group", "aria-label": say("roller.of", { what: called, side: say(`side.${side}`) }) },
    el("div", { class: "head row" }, el("h3", {}, swatch, called), moves(side, i, layers, panel)),
    panel.control(`${path}.thickness`),
    ...materialEditor(`${path}.material`, panel),
  );
}

function moves(side, i, layers, panel) {
  const called = say("roller.one-layer", { number: i + 1, side: say(`side.${side}`) });
  const act = (work) => () => change(panel, side, work);
  const swap = (j) =>
    act((list) => {
      [list[i], list[j]] = [list[j], list[i]];
    });
  const option = (what, extra = {}) => ({
    kind: "icon",
    label: `${say(`action.${what}`)} ${called}`,
    id: `${what}-${side}-${i}`,
    ...extra,
  });
  const remove = act((list) => list.splice(i, 1));
  const drop = () => {
    remove();
    document.getElementById(`add-${side}`).focus();
  };
  const several = layers.length > 1;
  return el(
    "div",
    { class: "moves" },
    several ? button(icon("up"), swap(i - 1), option("raise", { disabled: i === 0 })) : null,
    several
      ? button(icon("down"), swap(i + 1), option("lower", { disabled: i === layers.length - 1 }))
      : null,
    button(
      icon("copy"),
      act((list) => list.splice(i, 0, structuredClone(list[i]))),
      option("duplicate", { disabled: layers.length >= MOST_LAYERS }),
    ),
    button(icon("remove"), drop, option("remove")),
  );
}

/** The choice of what lies below the layers of a roller. */
export function coreEditor(side, tree, panel) {
  const { core } = tree[side];
  const put = (value) => panel.change(setAt(panel.app.store.state.case, `${side}.core`, value));
  const choose = (kind) =>
    put(kind === RIGID ? undefined : { model: "elastic", modulus: 70000, poisson: 0.33 });
  const options = [
    [RIGID, say("core.rigid")],
    ["soft", say("core.soft")],
  ];
  return el(
    "div",
    { class: "inner" },
    select({
      id: `in-${side}-core`,
      label: say("core.label", { side: say(`side.${side}`) }),
      options,
      value: core ? "soft" : RIGID,
      act: choose,
    }),
    core ? el("div", { class: "layer" }, ...materialEditor(`${side}.core`, panel)) : null,
  );
}

function change(panel, side, work) {
  panel.change(withLayers(panel.app.store.state.case, side, work));
}
