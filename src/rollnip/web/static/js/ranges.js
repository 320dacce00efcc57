// From where to where an input is varied: two boxes.

import { complaintOf, isAbort, post } from "./api.js";
import { questionOf } from "./control.js";
import { el } from "./dom.js";
import { say } from "./texts.js";
import { typable } from "./units.js";

/** Two boxes; `put(path, [low, high] or undefined)` takes what is typed, undefined where emptied. */
export class RangeBoxes {
  constructor(id, app, put) {
    this.app = app;
    this.put = put;
    this.asking = null; // AbortController of the texts being read
    this.read = Promise.resolve(); // until the texts in the boxes have been taken
    this.boxes = ["from", "to"].map((end) => {
      const input = el("input", { type: "text", id: `${id}-${end}`, autocomplete: "off" });
      const label = el("label", { for: `${id}-${end}`, text: say(`range.${end}`) });
      input.addEventListener("change", () => (this.read = this.typed()));
      return { end, input, label, node: el("div", { class: "field short" }, label, input) };
    });
    this.wrong = el("p", { class: "wrong", id: `${id}-range-wrong` });
    this.nodes = [...this.boxes.map(({ node }) => node), this.wrong];
  }

  /** Show the range of an input, [low, high] of its value in the case. */
  show(input, range) {
    this.input = input;
    const units = this.app.units();
    const { dimension, factor } = input;
    const unit = units.name(dimension);
    this.boxes.forEach(({ end, input: box, label }, i) => {
      label.textContent = say(`range.${end}`) + (unit ? ` [${unit}]` : "");
      if (document.activeElement !== box) box.value = typable(units.shown(range[i] * factor, dimension), 4);
    });
    this.wrong.textContent = "";
  }

  async typed() {
    const { path, dimension, factor } = this.input;
    const units = this.app.units();
    const texts = this.boxes.map(({ input }) => input.value.trim());
    this.asking?.abort(); // the newest texts hold
    this.asking = new AbortController();
    const { signal } = this.asking;
    if (texts.some((text) => text === "")) return this.put(path, undefined);
    try {
      const read = texts.map((text) =>
        post("/api/quantity", questionOf(text, dimension, units, path.endsWith("shore_a")), signal),
      );
      const ends = (await Promise.all(read)).map(({ value }) => value / factor);
      if (ends[0] === ends[1]) throw new Error(say("range.empty"));
      return this.put(path, [Math.min(...ends), Math.max(...ends)]);
    } catch (error) {
      if (!isAbort(error)) this.wrong.textContent = complaintOf(error);
      return undefined;
    }
  }
}
