// Tabs that show one curve along the nip.

import { figureIn } from "./quantities.js";
import { Chart } from "./charts.js";
import { button, el } from "./dom.js";
import { PLOTS } from "./plots.js";
import { say } from "./texts.js";

const FEET = {
  pressure:
    say("foot.pressure"),
  gap: say("foot.gap"),
  strain:
    say("foot.strain"),
  speed: say("foot.speed"),
  sheet: say("foot.sheet"),
};
const NONE = { speed: "foot.no-speed", sheet: "foot.no-sheet" };

/** The view of a curve: "pressure", "gap", "strain", "speed" or "sheet". */
export class CurveView {
  constructor(id, title, app) {
    this.id = id;
    this.title = title;
    this.app = app;
    const place = el("div", { class: "chart", id: `chart-${id}` });
    this.chart = new Chart(place);
    this.none = el("p", { class: "empty", text: NONE[id] ? say(NONE[id]) : "" });
    this.none.hidden = true;
    const exports = ["PNG", "SVG", "CSV"].map((format) =>
      button(format, () => app.exportChart(format), {
        kind: "small",
        id: `${id}-${format.toLowerCase()}`,
        label: say("chart.save", { format }),
      }),
    );
    const foot = el(
      "div",
      { class: "chart-foot" },
      (this.foot = el("p", { class: "hint", text: FEET[id] })),
      el("div", { class: "row" }, ...exports),
    );
    this.node = el("div", {}, place, this.none, foot);
  }

  /** Draw what is known; previews too. */
  show({ tree, result }) {
    const figure = PLOTS[this.id](result, this.app.units(), this.app.palette(), tree);
    this.chart.node.hidden = !figure;
    this.none.hidden = Boolean(figure);
    if (figure) this.chart.show(figure);
    if (this.id === "sheet") this.foot.textContent = sheetFoot(result, this.app.units());
  }

  /** The figure in light colours, for files. */
  figure({ tree, result }, palette) {
    return PLOTS[this.id](result, this.app.units(), palette, tree);
  }
}

/** What the chart of the sheet shows, whether its bending stiffness was counted, and its grip. */
function sheetFoot({ sheet }, units) {
  if (!sheet) return FEET.sheet;
  const parts = [FEET.sheet, say(sheet.bends ? "foot.sheet-bends" : "foot.sheet-free")];
  if (sheet.grip) {
    const [from, to] = ["smallest", "largest"].map((end) => units.figure(figureIn("pulls", end), sheet.grip[end]));
    parts.push(say(`foot.sheet-grip-${sheet.grip.first}`, { from, to }));
  }
  return parts.join(" ");
}
