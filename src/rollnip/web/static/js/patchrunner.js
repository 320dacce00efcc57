// Asks the server for a patch: on a coarse grid while inputs move, as fine as wanted once they rest.

import { isAbort, post } from "./api.js";
import { COARSE, patchCase } from "./patch.js";

/** Holds the last answers: the coarse one and the fine one. Asks only while the tab is open. */
export class PatchRunner {
  constructor(app, told) {
    this.told = told;
    this.answers = { coarse: null, fine: null }; // {key, result} each
    this.failure = null; // {key, error}
    this.wanted = null; // {key, tree, patch}
    this.isMoving = false;
    this.flight = null; // {key, abort} of the request under way
    app.store.listen((state, why) => this.heard(state, why));
  }

  heard({ case: tree, patch, view }, why) {
    this.wanted = patch && view.tab === "patch" ? { key: keyOf(tree, patch), tree, patch } : null;
    this.isMoving = why === "live";
    if (this.flight && this.flight.isFine && this.flight.key !== this.wanted?.key) this.flight.abort.abort();
    this.run();
    this.told();
  }

  /** {coarse, fine} of a design, each a result or null. */
  of(tree, patch) {
    const key = keyOf(tree, patch);
    const own = (name) => (this.answers[name]?.key === key ? this.answers[name].result : null);
    return { coarse: own("coarse"), fine: own("fine") };
  }

  failureOf(tree, patch) {
    return this.failure?.key === keyOf(tree, patch) ? this.failure.error : null;
  }

  /** Whether a design has all the answers that it is going to have. */
  isDone(tree, patch) {
    return !patch || Boolean(this.of(tree, patch).fine || this.failureOf(tree, patch));
  }

  /** What is asked next: "coarse", "fine" or nothing. */
  next() {
    if (!this.wanted) return null;
    const { tree, patch } = this.wanted;
    if (this.isDone(tree, patch)) return null;
    if (!this.of(tree, patch).coarse) return "coarse";
    return this.isMoving ? null : "fine";
  }

  async run() {
    if (this.flight) return;
    for (let what = this.next(); what; what = this.next()) await this.once(what);
  }

  async once(what) {
    const { key, tree, patch } = this.wanted;
    const abort = new AbortController();
    this.flight = { key, abort, isFine: what === "fine" };
    try {
      const body = patchCase(tree, patch, what === "coarse" ? COARSE : null);
      this.answers[what] = { key, result: await post("/api/patch", body, abort.signal) };
      this.failure = null;
    } catch (error) {
      if (!isAbort(error)) this.failure = { key, error };
    } finally {
      this.flight = null;
    }
    this.told();
  }
}

function keyOf(tree, patch) {
  return JSON.stringify(patchCase({ ...tree, title: "" }, patch));
}
