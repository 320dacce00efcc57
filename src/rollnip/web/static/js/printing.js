// Printing: the report, from the button of the page as from the menu of the browser.

import { nameOf } from "./design.js";
import { paletteOf } from "./palette.js";
import { fillReport, fillRefusal } from "./report.js";
import { say } from "./texts.js";

/** Puts the report in the place of the page while a browser prints. `app` is what gives the answer. */
export class Printing {
  constructor(app) {
    this.app = app;
    this.filled = null; // {snapshot, face, system} of the report as it stands
    addEventListener("beforeprint", () => this.begin());
    addEventListener("afterprint", () => delete document.documentElement.dataset.report);
  }

  /** Write the report and show it on paper; throws where there is no answer to print, or no chart yet. */
  fill() {
    document.documentElement.dataset.report = "yes";
    const answer = this.app.drawnAnswer;
    const { snapshot } = this.app;
    const units = this.app.units();
    const made = { snapshot, face: answer.face, system: units.system };
    if (this.filled && Object.keys(made).every((key) => made[key] === this.filled[key])) return;
    const date = new Date().toISOString().slice(0, 10);
    fillReport(answer, units, paletteOf("light"), date);
    this.filled = made;
  }

  /** A browser does not wait: what is not there yet is said instead. */
  begin() {
    try {
      this.fill();
    } catch (error) {
      this.filled = null;
      fillRefusal(nameOf(this.app.store.state.case), `${say("report.failed")}: ${error.message}`);
    }
  }
}
