// Printing: the report, from the button of the page as from the menu of the browser.

import { nameOf } from "./design.js";
import { paletteOf } from "./palette.js";
import { fillReport, fillRefusal } from "./report.js";
import { say } from "./texts.js";

/** Puts the report in the place of the page while a browser prints. `app` is what gives the answer. */
export class Printing {
  constructor(app) {
    this.app = app;
    this.filled = null; // {answer, system} of the report as it stands
    addEventListener("beforeprint", () => this.begin());
    addEventListener("afterprint", () => delete document.documentElement.dataset.report);
  }

  /** Write the report and show it on paper; throws where there is no answer to print, or no chart yet. */
  fill() {
    document.documentElement.dataset.report = "yes";
    const answer = this.app.drawnAnswer;
    const units = this.app.units();
    if (this.filled?.answer === answer && this.filled.system === units.system) return;
    const date = new Date().toISOString().slice(0, 10);
    fillReport(answer, units, paletteOf("light"), date);
    this.filled = { answer, system: units.system };
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
