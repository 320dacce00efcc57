// A table of numbers as lines of a text box: typed, or pasted from a spreadsheet.

import { el } from "./dom.js";
import { getAt, idOf } from "./paths.js";
import { say } from "./texts.js";
import { typable } from "./units.js";

const DIGITS = 6;

/** The numbers of a line; null where a part of it is none. Tabs, semicolons or blanks part them. */
export function numbersOf(line) {
  const parts = /[;\t]/.test(line) ? line.split(/[;\t]/) : line.split(/,?\s+/);
  const texts = parts.map((part) => part.trim().replace(/^([-+]?\d*),(\d+)$/, "$1.$2")).filter((part) => part !== "");
  const values = texts.map(Number);
  return values.every(Number.isFinite) ? values : null;
}

/**
 * Rows of numbers at a path of the design. `columns` are {label, dimension, isOptional}; `read(value)`
 * gives the rows of what stands at the path, `write(rows)` what is to stand there, null where it cannot
 * be. It stands among the controls of the inputs.
 */
export class TableBox {
  constructor({ path, label, columns, read, write, rows = 4 }, panel) {
    Object.assign(this, { path, columns, read, write, panel, app: panel.app });
    this.isUnread = false;
    const id = `${idOf(path)}-table`;
    this.box = el("textarea", { id, rows, spellcheck: "false", "aria-describedby": `${id}-hint ${id}-wrong` });
    this.hint = el("p", { class: "hint", id: `${id}-hint` });
    this.wrong = el("p", { class: "wrong", id: `${id}-wrong` });
    this.box.addEventListener("change", () => this.typed());
    this.node = el("div", { class: "field" }, el("label", { for: id, text: label }), this.box, this.hint, this.wrong);
    this.refresh(this.app.store.state.case);
  }

  refresh(tree) {
    const value = getAt(tree, this.path);
    if (value === undefined) return;
    const units = this.app.units();
    const names = this.columns.map(({ label, dimension }) => {
      const unit = units.name(dimension);
      return unit ? `${label} [${unit}]` : label;
    });
    this.hint.textContent = say("table.hint", { columns: names.join(", ") });
    const lines = this.read(value).map((row) =>
      row.map((one, i) => typable(units.shown(one, this.columns[i].dimension), DIGITS)).join("\t"),
    );
    const text = lines.join("\n");
    if (text === this.text) return;
    this.text = text;
    this.box.value = text;
    this.complain("");
  }

  typed() {
    const units = this.app.units();
    const least = this.columns.filter(({ isOptional }) => !isOptional).length;
    const rows = [];
    for (const [i, line] of this.box.value.split(/\r?\n/).entries()) {
      if (line.trim() === "") continue;
      const values = numbersOf(line);
      if (!values || values.length < least || values.length > this.columns.length)
        return this.complain(say("table.line", { line: i + 1, count: least, most: this.columns.length }));
      rows.push(values.map((one, j) => units.base(one, this.columns[j].dimension)));
    }
    const value = rows.length ? this.write(rows) : null;
    if (value === null) return this.complain(say("table.rows"));
    this.text = null; // written anew, as it was understood
    this.complain("");
    return this.app.store.design({ case: this.treeWith(value) });
  }

  treeWith(value) {
    return this.panel.withAt(this.path, value);
  }

  /** What the server says of the table. */
  refuse(message) {
    if (!this.isUnread) this.say(message);
  }

  complain(message) {
    this.isUnread = message !== "";
    this.say(message);
    this.app.stand();
  }

  say(message) {
    this.wrong.textContent = message;
    if (message) this.box.setAttribute("aria-invalid", "true");
    else this.box.removeAttribute("aria-invalid");
  }
}

/** Columns {name: [...]} of rows; a name whose values are missing in some row is left out. */
export function columnsOf(names, rows) {
  const whole = names.filter((_name, j) => rows.every((row) => row[j] !== undefined));
  return Object.fromEntries(whole.map((name) => [name, rows.map((row) => row[names.indexOf(name)])]));
}

/** Rows of columns {name: [...]}. */
export function rowsOf(names, columns) {
  const there = names.filter((name) => columns[name] !== undefined);
  return columns[there[0]].map((_one, i) => there.map((name) => columns[name][i]));
}
