// What the page knows and does; views and menus call it.

import { Actions } from "./actions.js";
import { announce, clearAlarm, alarm, showAnswers, showStanding, unsoundAlarm } from "./answers.js";
import { isAbort, onOutage, post, sentencesOf } from "./api.js";
import { Asker } from "./asker.js";
import { later, underway } from "./busy.js";
import { defaultCase, nameOf } from "./design.js";
import { button, byId, toast } from "./dom.js";
import { Drawings } from "./drawings.js";
import { sameNip } from "./face.js";
import { FACE_ROUTE } from "./faceview.js";
import { bareMaterial } from "./heat.js";
import { HEAT_ROUTE } from "./heatview.js";
import { wireHeader } from "./header.js";
import { Inputs } from "./inputs.js";
import { examplesDialog } from "./menus.js";
import { measuredIn } from "./measured.js";
import { paletteOf } from "./palette.js";
import { same } from "./paths.js";
import { blamed, complaintsOf } from "./places.js";
import { modulusOf } from "./materials.js";
import { PatchRunner } from "./patchrunner.js";
import { linkOf } from "./permalink.js";
import { Printing } from "./printing.js";
import { Runner } from "./runner.js";
import { remember, remembered } from "./saved.js";
import { Store } from "./store.js";
import { Tabs } from "./tabs.js";
import { say } from "./texts.js";
import { Theme } from "./theme.js";
import { Units } from "./units.js";
import { VIEW } from "./view.js";
import { viewsOf } from "./views.js";

const IDLE = 300; // ms after which a slider rests
const QUIET = 250; // ms after which the address follows

/** The designer. */
export class App extends Actions {
  constructor({ units, materials, hardness, examples }) {
    super();
    this.table = units;
    this.library = materials.filter(({ family }) => !family);
    this.families = materials.filter(({ family }) => family);
    this.hardness = hardness;
    this.snapshot = null; // {tree, result, state, surfaces, isPlaced} last shown
    this.failure = null; // {tree, error} where the design at hand has no answer
    this.broken = null; // why a link could not be opened, until something else is asked for
    this.isOut = false; // whether the server has stopped answering
    this.isUnread = false; // whether a box held what cannot be read when it was last asked
    this.reading = 0; // texts that the server is reading
    this.isMoving = false; // whether a slider moves
    this.stopIdling = () => {}; // gives up the wait for a slider to rest
    this.stopRemembering = () => {};
    const system = remembered("system") === "us" ? "us" : "metric";
    this.store = new Store({ case: defaultCase(system), kept: [], patch: null, view: { ...VIEW, system } });
    this.isPristine = true; // nothing was put in yet: round numbers in the units shown
    this.theme = new Theme(() => this.recolour());
    this.runner = new Runner({
      preview: (tree, result) => this.answered(tree, result, "preview"),
      settled: (tree, result) => this.answered(tree, result, "settled"),
      surfaces: (tree, surfaces, result) => this.placed(tree, surfaces, result),
      failed: (tree, error) => this.failed(tree, error),
      busy: (yes) => this.busy(yes),
    });
    this.inputs = new Inputs(byId("inputs"), this);
    this.faces = new Asker(this, FACE_ROUTE, () => this.told("face", this.faces));
    this.heats = new Asker(this, HEAT_ROUTE, () => this.told("heat", this.heats));
    this.patches = new PatchRunner(this, () => this.patchTold());
    this.drawings = new Drawings(byId("drawings"), this);
    this.tabs = new Tabs(viewsOf(this), this);
    this.examples = examplesDialog(examples, (example) => this.open(example.case, example.title));
    this.printing = new Printing(this);
    wireHeader(this);
    onOutage((yes) => {
      this.isOut = yes;
      this.stand();
    });
    this.store.listen((state, why) => this.changed(state, why));
  }

  /** Show other units from now on; a start that nobody touched has round numbers in them. */
  measure(system) {
    remember("system", system);
    const isStart = this.isPristine && this.store.past.length === 0;
    this.store.view({ system });
    if (isStart) this.store.replace({ ...this.store.state, case: defaultCase(system) });
  }

  units() {
    return new Units(this.table, this.store.state.view.system);
  }

  palette() {
    return paletteOf(this.theme?.name);
  }

  last() {
    return this.snapshot;
  }

  result() {
    return this.snapshot?.result;
  }

  /** Likely modulus of a hardness [MPa]. */
  modulusOf(shore) {
    return modulusOf(shore, this.hardness).likely;
  }

  /** The entry of the library that a material is, if any. */
  libraryEntry(material) {
    return this.library.find((entry) => same(entry.material, bareMaterial(material)));
  }

  /** Something changed: ask for the answer, or only show anew. */
  changed(state, why) {
    byId("undo").disabled = this.store.past.length === 0;
    byId("redo").disabled = this.store.future.length === 0;
    byId("design-title").value = state.case.title ?? "";
    for (const system of ["metric", "us"])
      byId(system).setAttribute("aria-pressed", String(state.view.system === system));
    this.tabs.refresh();
    if (why === "view") this.showAll();
    else if (why === "opened" || !this.keepsAnswer(state.case, why)) this.ask(state.case, why);
    this.stand();
  }

  /** Whether only the name or the face is another: the answer of the nip is the same one then. */
  keepsAnswer(tree, why) {
    const before = this.snapshot;
    const standing = this.standing();
    if (!before?.isPlaced || before.state !== "settled" || this.runner.isBusy) return false;
    if ((standing !== "computing" && standing !== "settled") || !sameNip(tree, before.tree)) return false;
    this.snapshot = { ...before, tree, result: { ...before.result, title: tree.title } };
    this.stopIdling();
    if (why === "live") this.stopIdling = later(() => this.store.rest(), IDLE);
    this.tabs.open.show(this.snapshot);
    this.remember();
    if (!this.snapshot.known) this.learn(tree);
    return true;
  }

  ask(tree, why) {
    this.stopIdling();
    this.isMoving = why === "live";
    document.documentElement.dataset.state = "waiting";
    document.documentElement.classList.toggle("moving", this.isMoving);
    this.broken = null;
    if (why === "design" || why === "opened") this.failure = null;
    if (this.snapshot?.tree !== tree) this.learning?.abort();
    if (this.isMoving) this.move(tree);
    else this.runner.settle(tree, why === "rest");
  }

  /** How what is shown stands to the inputs: only "settled" is their answer. */
  standing() {
    if (this.broken) return "none";
    if (this.inputs.isUnread()) return "unread"; // what was refused before is not what stands there now
    if (this.failure) return "none";
    if (this.reading > 0 || this.snapshot?.tree !== this.store.state.case) return "computing";
    return this.snapshot.state;
  }

  /** Show how what is shown stands to the inputs, and what must be said above everything. */
  stand() {
    if (!this.inputs) return; // the boxes write for the first time
    const standing = this.standing();
    showStanding(standing, this.snapshot, this.units());
    if (this.isOut) alarm(say("outage.title"), [say("outage.text")]);
    else if (this.broken) this.alarmLink();
    else if (standing === "none") this.alarmFailure();
    else if (standing === "settled" && !this.snapshot.result.converged) unsoundAlarm(this.snapshot.result, this.units());
    else clearAlarm();
    const isUnread = standing === "unread";
    if (isUnread !== this.isUnread) this.tabs?.open.refresh?.();
    this.isUnread = isUnread;
  }

  alarmLink() {
    const goOn = () => this.ask(this.store.state.case, "design");
    const go = button(say("link.go-on"), () => [goOn(), this.stand()], { id: "link-go-on" });
    alarm(say("link.title"), [this.broken, say("link.text")], go);
  }

  /** No figure passes for the answer while a text is read; `work` ends when it has been taken. */
  async reads(work) {
    this.reading += 1;
    this.stand();
    await underway("reading", work);
    this.reading -= 1;
    this.stand();
  }

  /** An exact answer is under way, or there is none; a slider that moves is going to ask for one. */
  busy(yes) {
    byId("answers").setAttribute("aria-busy", String(yes));
    if (!yes && !this.isMoving) document.documentElement.dataset.state = "rest";
  }

  /** A slider moves; when it has rested for a while, the exact answer is asked for. */
  move(tree) {
    this.runner.preview(tree);
    this.stopIdling = later(() => this.store.rest(), IDLE);
  }

  answered(tree, result, state) {
    const moved = this.snapshot && state === "preview";
    const surfaces = this.snapshot?.surfaces ?? null;
    const known = this.snapshot?.tree === tree ? this.snapshot.known : null;
    this.snapshot = { tree, result, state, surfaces, isPlaced: false, known };
    this.failure = null;
    this.complainAt();
    byId("drawings").classList.add("old");
    showAnswers(this.snapshot, this.units());
    this.stand();
    this.tabs.open.show(this.snapshot);
    if (!moved) {
      announce(result, this.units());
      this.remember();
    }
  }

  placed(tree, surfaces, result) {
    if (this.snapshot?.result !== result) return;
    this.snapshot = { ...this.snapshot, surfaces, isPlaced: true };
    byId("drawings").classList.remove("old");
    this.drawings.show(this.snapshot);
    if (this.snapshot.state === "settled" && !this.snapshot.known) this.learn(tree);
  }

  /** What else is known of the figures: two more solves, so once things are quiet. */
  async learn(tree) {
    this.learning?.abort();
    const learning = new AbortController();
    this.learning = learning;
    const body = { case: tree, measured: measuredIn(tree, this.store.state.view.measured) };
    try {
      const known = await post("/api/known", body, learning.signal);
      if (this.snapshot.tree !== tree) return;
      this.snapshot = { ...this.snapshot, known };
      showAnswers(this.snapshot, this.units());
      this.stand();
    } catch (error) {
      if (!isAbort(error)) this.complain(sentencesOf(error)[0]);
    }
  }

  failed(tree, error) {
    const details = (error.details ?? []).map((one) => blamed({ ...one, path: one.path || inputSaid(one.message, tree) }, tree));
    this.failure = { tree, error: { message: error.message, details } };
    this.complainAt();
    this.stand();
  }

  /** The complaints of the server, about the nip, its face and its heat, at their inputs. */
  complainAt() {
    const { case: tree } = this.store.state;
    const others = [this.faces, this.heats].flatMap((asker) => asker.failureOf(tree)?.details ?? []);
    this.inputs.complain([...(this.failure?.error.details ?? []), ...others]);
  }

  /** The face or the heat of the design at hand is there, is refused, or is not there yet. */
  told(what, asker) {
    document.documentElement.dataset[what] = asker.isDone(this.store.state.case) ? "rest" : "waiting";
    this.complainAt();
    this.tabs.open.refresh?.();
  }

  /** The patch of the design at hand is there, is refused, or is not there yet. */
  patchTold() {
    const { case: tree, patch } = this.store.state;
    document.documentElement.dataset.patch = this.patches.isDone(tree, patch) ? "rest" : "waiting";
    if (this.tabs?.open.id === "patch") this.tabs.open.refresh();
  }

  /** Each complaint at its input and, in words, above everything. */
  alarmFailure() {
    const { tree, error } = this.failure;
    alarm(say("alarm.none"), complaintsOf(error, tree, this.units()));
  }

  /** The same answer, or that there is none, in other units, colours or tabs. */
  showAll() {
    if (this.snapshot) {
      this.remember();
      showAnswers(this.snapshot, this.units());
      this.drawings.show(this.snapshot);
      this.tabs.open.show(this.snapshot);
    }
    this.complainAt();
  }

  recolour() {
    const isDark = this.theme?.name === "dark" || document.documentElement.dataset.theme === "dark";
    byId("theme").setAttribute("aria-pressed", String(isDark));
    if (!this.snapshot) return;
    this.inputs.rebuild();
    this.showAll();
  }

  /** Put the state into the address, once things are quiet. */
  remember() {
    this.stopRemembering();
    this.stopRemembering = later(() => underway("waiting", this.write()), QUIET);
  }

  async write() {
    if (this.store.past.length > 0) remember("last", JSON.stringify(this.whole));
    history.replaceState(null, "", await this.link());
  }

  /** The state as links and projects hold it. */
  get whole() {
    const { view, ...rest } = this.store.state;
    return { ...rest, ...view };
  }

  link() {
    return linkOf(this.whole);
  }

  say(text) {
    toast(text);
  }

  complain(text) {
    toast(text);
  }

  /** Name and normalised texts of the design at hand: {hash, toml, python}. */
  written() {
    return post("/api/case", this.store.state.case);
  }

  get name() {
    return nameOf(this.store.state.case);
  }
}

/** The path of the input that a sentence about none begins with; "" where it is none of the nip's. */
function inputSaid(message, tree) {
  const [, name] = message.match(/^`([a-z_]+)` /) ?? [];
  return typeof tree.nip[name] === "number" ? `nip.${name}` : "";
}
