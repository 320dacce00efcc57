// The menus of the header and the dialog of examples.

import { nameOf } from "./design.js";
import { button, byId, el } from "./dom.js";
import { icon } from "./icons.js";
import { removeDesign, savedDesigns } from "./saved.js";
import { say } from "./texts.js";

const GROUPS = [
  ["typical", "Typical nips"],
  ["paper", "From the literature: Braat and Kalker (1993)"],
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
    el("h3", { text: "Share" }),
    item("Copy a link to this page", () => app.copyLink(), close, "copy-link"),
    item("Print a one-page report", () => app.report(), close, "print-report"),
    el("h3", { text: "Case file" }),
    item("Save as TOML", () => app.saveToml(), close, "save-toml"),
    item("Open a TOML file …", () => byId("file").click(), close, "load-toml"),
    item("Copy as TOML", () => app.copyCode("toml"), close, "copy-toml"),
    item("Copy as Python", () => app.copyCode("python"), close, "copy-python"),
    el("h3", { text: "Data and pictures" }),
    item("Curves as CSV", () => app.saveCsv("curves"), close, "csv-curves"),
    item("Key figures as CSV", () => app.saveCsv("figures"), close, "csv-figures"),
    item(say("json.item"), () => app.saveJson(), close, "save-json"),
    item("Drawing as SVG", () => app.saveDrawing("svg"), close, "drawing-svg"),
    item("Drawing as PNG", () => app.saveDrawing("png"), close, "drawing-png"),
  ];
}

/** What the menu "Designs" holds. */
export function designItems(app) {
  return (close) => {
    const rows = savedDesigns().map(({ name, case: tree }, i) => {
      const forget = () => {
        removeDesign(name);
        close();
        app.say(`“${name}” was removed.`);
      };
      return el(
        "div",
        { class: "saved" },
        item(name, () => app.open(tree), close, `saved-${i}`),
        button(icon("remove"), forget, { kind: "icon", label: `Remove ${name}`, id: `forget-${i}` }),
      );
    });
    const none = el("p", { class: "hint", text: "Nothing saved in this browser yet." });
    return [
      item(`Save “${nameOf(app.store.state.case)}”`, () => app.save(), close, "save-design"),
      item("Keep for comparison", () => app.keep(), close, "keep-design"),
      item("Start anew", () => app.startAnew(), close, "start-anew"),
      el("h3", { text: "Saved in this browser" }),
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
  const close = button("Close", () => dialog.close(), { id: "examples-close" });
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
    el("header", {}, el("h2", { id: "examples-title", text: "Examples" }), close),
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
  const close = button("Close", () => dialog.close());
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
