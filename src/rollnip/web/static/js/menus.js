// The menus of the header and the dialog of examples.

import { nameOf } from "./design.js";
import { button, byId, el } from "./dom.js";
import { icon } from "./icons.js";
import { removeDesign, savedDesigns } from "./saved.js";
import { say } from "./texts.js";

const GROUPS = [
  ["typical", say("examples.typical")],
  ["more", say("examples.more")],
  ["paper", say("examples.paper")],
];

/** A button of the header that opens a menu; `items` gives its elements anew each time. */
export function menu(id, label, items) {
  const opener = byId(id);
  const panel = el("div", {
    class: "menu",
    popover: "auto",
    id: `${id}-menu`,
    role: "dialog",
    "aria-label": label,
  });
  document.body.append(panel);
  const open = () => {
    panel.replaceChildren(...items(() => panel.hidePopover()));
    panel.showPopover();
    place(panel, opener);
    panel.querySelector("button, input")?.focus();
  };
  opener.addEventListener("click", open);
  panel.addEventListener("toggle", (event) => {
    opener.setAttribute("aria-expanded", String(event.newState === "open"));
  });
}

function place(panel, opener) {
  const box = opener.getBoundingClientRect();
  const left = Math.min(box.left, innerWidth - panel.offsetWidth - 10);
  panel.style.left = `${Math.max(10, left)}px`;
  panel.style.top = `${box.bottom + 6}px`;
}

/** An entry of a menu, which closes it. */
export function item(text, act, close, id = null) {
  return el("button", {
    type: "button",
    class: "item",
    id,
    text,
    on: {
      click: () => {
        close();
        act();
      },
    },
  });
}

/** What the menu "Save & share" holds. */
export function shareItems(app) {
  return (close) => [
    el("h3", { text: say("share.title") }),
    item(say("share.link"), () => app.copyLink(), close, "copy-link"),
    item(say("share.report"), () => app.report(), close, "print-report"),
    el("h3", { text: say("file.case") }),
    item(say("share.save-toml"), () => app.saveToml(), close, "save-toml"),
    item(say("share.load-toml"), () => byId("file").click(), close, "load-toml"),
    item(say("share.copy-toml"), () => app.copyCode("toml"), close, "copy-toml"),
    item(say("share.copy-python"), () => app.copyCode("python"), close, "copy-python"),
    el("h3", { text: say("share.data") }),
    item(say("share.curves"), () => app.saveCsv("curves"), close, "csv-curves"),
    item(say("share.figures"), () => app.saveCsv("figures"), close, "csv-figures"),
    item(say("json.item"), () => app.saveJson(), close, "save-json"),
    item(say("share.svg"), () => app.saveDrawing("svg"), close, "drawing-svg"),
    item(say("share.png"), () => app.saveDrawing("png"), close, "drawing-png"),
  ];
}

/** What the menu say("menu.designs") holds. */
export function designItems(app) {
  return (close) => {
    const rows = savedDesigns().map(({ name, case: tree }, i) => {
      const forget = () => {
        removeDesign(name);
        close();
        app.say(say("designs.removed", { name }));
      };
      return el(
        "div",
        { class: "saved" },
        item(name, () => app.open(tree), close, `saved-${i}`),
        button(icon("remove"), forget, { kind: "icon", label: say("action.remove-one", { name }), id: `forget-${i}` }),
      );
    });
    const none = el("p", { class: "hint", text: say("designs.none") });
    return [
      item(say("designs.save", { name: nameOf(app.store.state.case) }), () => app.save(), close, "save-design"),
      item(say("designs.keep"), () => app.keep(), close, "keep-design"),
      item(say("designs.anew"), () => app.startAnew(), close, "start-anew"),
      el("h3", { text: say("designs.saved") }),
      ...(rows.length ? rows : [none]),
      el("h3", { text: say("project.title") }),
      item(say("project.save"), () => app.saveProject(), close, "save-project"),
      item(say("project.load"), () => byId("file").click(), close, "load-project"),
    ];
  };
}

/** The dialog of examples; a click opens one. */
export function examplesDialog(examples, choose) {
  const dialog = el("dialog", { id: "examples", "aria-labelledby": "examples-title" });
  const close = button(say("action.close"), () => dialog.close(), { id: "examples-close" });
  const pick = (example) => () => {
    dialog.close();
    choose(example);
  };
  const tile = (example) =>
    el(
      "button",
      { type: "button", class: "tile", id: `example-${example.name}`, on: { click: pick(example) } },
      el("b", { text: example.title }),
      el("span", { text: example.description }),
    );
  const groups = GROUPS.map(([group, title]) => [
    title,
    examples.filter((one) => one.group === group),
  ]).filter(([, list]) => list.length);
  const body = groups.flatMap(([title, list]) => [
    el("h3", { text: title }),
    el("div", { class: "tiles" }, ...list.map(tile)),
  ]);
  dialog.append(
    el("header", {}, el("h2", { id: "examples-title", text: say("menu.examples") }), close),
    el("div", { class: "body" }, ...body),
  );
  document.body.append(dialog);
  return dialog;
}

/** A text that could not be copied, shown to be copied by hand. */
export function textDialog(title, text) {
  const area = el("textarea", { rows: 18, readonly: true, "aria-label": title });
  area.value = text;
  const dialog = el("dialog", { "aria-label": title });
  const close = button(say("action.close"), () => dialog.close());
  dialog.append(el("header", {}, el("h2", { text: title }), close), el("div", { class: "body" }, area));
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
  area.select();
}

/** A question with some answers, [key, text] each; the key chosen, "" where it was only closed. */
export function askDialog(title, text, answers) {
  const dialog = el("dialog", { class: "ask-dialog", "aria-label": title });
  const choose = (key) => () => dialog.close(key);
  const buttons = answers.map(([key, words], i) =>
    button(words, choose(key), { kind: i === 0 ? "main" : "", id: `answer-${key || "none"}` }),
  );
  dialog.append(
    el("header", {}, el("h2", { text: title })),
    el("div", { class: "body" }, el("p", { text }), el("div", { class: "row" }, ...buttons)),
  );
  document.body.append(dialog);
  dialog.showModal();
  return new Promise((resolve) => {
    dialog.addEventListener("close", () => {
      dialog.remove();
      resolve(dialog.returnValue);
    });
  });
}
