// What the menus do: open, keep, save, copy, export, print. The App is what they act on.

import { post, sentencesOf } from "./api.js";
import { underway } from "./busy.js";
import { plotly } from "./charts.js";
import { defaultCase, nameOf } from "./design.js";
import {
  chartCsv,
  download,
  drawingSvg,
  figuresCsv,
  fileName,
  profilesCsv,
  rowsCsv,
  rasterOf,
  saveChart,
} from "./files.js";
import { MOST_KEPT } from "./compare.js";
import { askDialog, textDialog } from "./menus.js";
import { Opening } from "./opening.js";
import { paletteOf } from "./palette.js";
import { same } from "./paths.js";
import { saveDesign, savedDesigns } from "./saved.js";
import { say } from "./texts.js";

const PROJECT = "rollnip_project";
const LIGHT = "light"; // of every export
const REFUSALS = {
  none: "refuse.none",
  unread: "refuse.unread",
  computing: "refuse.computing",
  preview: "refuse.computing",
};

/** Actions on `this.store`, `this.snapshot`, `this.tabs`, `this.faces`, `this.heats`, `this.printing`. */
export class Actions extends Opening {
  /** Open a case from anywhere; the one at hand can be had back with undo. */
  open(tree, title = null) {
    const isNewest = this.opening();
    const read = async () => {
      const design = await this.checked(tree);
      if (isNewest()) this.store.design({ case: { ...design, title: design.title || title || "" } });
    };
    return underway("opening", this.attempt(say("open.failed"), read));
  }

  startAnew() {
    this.store.design({ case: defaultCase(this.store.state.view.system) });
  }

  loadFile(file) {
    const isNewest = this.opening();
    const read = async () => {
      const text = await file.text();
      const project = projectIn(text);
      if (project) return this.openProject(project);
      const { case: tree } = await post("/api/toml", { text });
      const design = await this.checked(tree);
      if (!isNewest()) return undefined;
      this.store.design({ case: { ...design, title: design.title || file.name.replace(/\.[^.]*$/, "") } });
      return this.say(say("open.file", { name: file.name }));
    };
    return underway("opening", this.attempt(say("open.file-failed", { name: file.name }), read));
  }

  /** All saved designs and the one at hand in one file. */
  saveProject() {
    const designs = savedDesigns();
    const text = JSON.stringify({ [PROJECT]: 1, designs, last: this.whole }, null, 1);
    download("rollnip-project.json", text, "application/json");
  }

  /** Put the designs of a project file among the saved ones, beside those of the same name. */
  async openProject({ designs, last }) {
    const read = await Promise.all(designs.map(async (one) => ({ ...one, case: await this.checked(one.case) })));
    for (const { name, case: tree } of read.reverse()) {
      const taken = savedDesigns();
      const isThere = taken.some((one) => one.name === name && same(one.case, tree));
      if (!isThere) saveDesign(otherName(name, taken), tree);
    }
    if (last) await this.restore(last);
    this.say(say("project.open", { count: read.length }));
  }

  /** Save the design in this browser. */
  async save() {
    await this.attempt(say("save.failed"), async () => {
      const tree = this.store.state.case;
      const name = await this.freeName(this.name, tree);
      if (name === null) return;
      saveDesign(name, { ...tree, title: tree.title && name });
      this.say(say("save.done", { name }));
    });
  }

  /** The name to save under, once nothing else is lost by it; null where it is not to be saved. */
  async freeName(name, tree) {
    const taken = new Map(savedDesigns().map((one) => [one.name, one.case]));
    if (!taken.has(name) || same(taken.get(name), tree)) return name;
    const other = otherName(name, savedDesigns());
    const answer = await askDialog(say("save.exists", { name }), say("save.ask"), [
      ["replace", say("save.replace")],
      ["both", say("save.both", { name: other })],
      ["", say("save.cancel")],
    ]);
    return { replace: name, both: other }[answer] ?? null;
  }

  keep() {
    const { kept, case: tree } = this.store.state;
    if (kept.length >= MOST_KEPT) return this.say(say("keep.full"));
    const free = [..."ABC"].find((letter) => kept.every(({ title }) => title !== say("keep.name", { letter })));
    const named = { ...tree, title: tree.title || say("keep.name", { letter: free }) };
    this.store.design({ kept: [...kept, named] });
    this.store.view({ tab: "compare" });
    return this.say(say("keep.done", { name: nameOf(named) }));
  }

  openKept(i) {
    this.store.design({ case: this.store.state.kept[i] });
  }

  dropKept(i) {
    this.store.design({ kept: this.store.state.kept.filter((_one, j) => j !== i) });
  }

  async copyLink() {
    await this.copy(await this.link(), say("copy.link"));
  }

  async copyCode(language) {
    await this.attempt(say("write.failed"), async () => {
      const written = await this.written();
      await this.copy(written[language], language === "toml" ? say("copy.toml") : say("copy.python"));
    });
  }

  async copy(text, what) {
    try {
      await navigator.clipboard.writeText(text);
      this.say(say("copy.done", { what }));
    } catch {
      textDialog(what, text);
    }
  }

  async saveToml() {
    await this.attempt(say("write.failed"), async () => {
      const { toml } = await this.written();
      download(fileName(this.store.state.case, "toml"), toml, "application/toml");
    });
  }

  /** {tree, result, face, heat, ...} of the design at hand. Throws where what is shown is not its answer. */
  get answer() {
    const standing = this.standing();
    if (standing !== "settled") throw new Error(say(REFUSALS[standing]));
    const { tree } = this.snapshot;
    const askers = [this.faces, this.heats];
    if (!askers.every((asker) => asker.isDone(tree))) throw new Error(say("refuse.computing"));
    const [face, heat] = askers.map((asker) => asker.of(tree));
    return { ...this.snapshot, face, heat };
  }

  /** The same with the surfaces as computed. */
  get drawnAnswer() {
    const { answer } = this;
    if (!answer.isPlaced) throw new Error(say("refuse.computing"));
    return answer;
  }

  async saveCsv(what) {
    await this.attempt(say("csv.failed"), () => {
      const { tree, result } = this.answer;
      const units = this.units();
      const text = what === "curves" ? profilesCsv(result, units) : figuresCsv(this.answer, units);
      download(fileName(tree, `${what}.csv`), text, "text/csv");
    });
  }

  /** Everything that was computed, as the command line gives it, with the case and what is known. */
  async saveJson() {
    await this.attempt(say("json.failed"), async () => {
      const { tree, known, face, heat } = this.answer;
      const result = await post("/api/solve?whole=false", tree);
      const text = JSON.stringify({ case: tree, result, known, ...(face ? { face } : {}), ...(heat ? { heat } : {}) }, null, 1);
      download(fileName(tree, "json"), text, "application/json");
    });
  }

  async saveDrawing(format) {
    await this.attempt(say("drawing.failed"), async () => {
      const { tree } = this.drawnAnswer;
      const text = drawingSvg(this.drawnAnswer, { palette: paletteOf(LIGHT), units: this.units() });
      const content = format === "svg" ? new Blob([text], { type: "image/svg+xml" }) : await rasterOf(text);
      download(fileName(tree, `drawing.${format}`), content);
    });
  }

  /** The open chart as PNG, SVG or CSV. */
  async exportChart(format) {
    await this.attempt(say("chart.failed"), async () => {
      const view = this.tabs.open;
      const figure = view.isOld?.() ? null : view.figure(this.answer, paletteOf(LIGHT));
      const name = fileName(this.answer.tree, `${view.id}.${format.toLowerCase()}`);
      if (!figure) throw new Error(say("refuse.empty"));
      if (format === "CSV") download(name, view.csvRows ? rowsCsv(view.csvRows()) : chartCsv(figure), "text/csv");
      else await saveChart(figure, format, name);
    });
  }

  async report() {
    await this.attempt(say("report.failed"), async () => {
      await plotly();
      this.printing.fill();
      print();
    });
  }

  /** Do something; say in a sentence where it does not work. */
  async attempt(failure, act) {
    try {
      await act();
    } catch (error) {
      this.complain(`${failure}: ${sentencesOf(error, keyOf).slice(0, 3).join(" ")}`);
    }
  }
}

/** The name, with a number where it is taken. */
function otherName(name, saved) {
  const taken = new Set(saved.map((one) => one.name));
  let other = name;
  for (let count = 2; taken.has(other); count += 1) other = `${name} (${count})`;
  return other;
}

/** {designs, last} where a text is a project file; null where it is not. */
function projectIn(text) {
  if (!text.trimStart().startsWith("{")) return null;
  try {
    const tree = JSON.parse(text);
    return tree[PROJECT] && Array.isArray(tree.designs) ? tree : null;
  } catch {
    return null;
  }
}

/** A place as a case file writes it, for those who look for it there. */
function keyOf(path) {
  return path ? `${path}: ` : "";
}
