// Asks the server for what stands beside the figures of the nip, such as its face; the newest design wins.

import { isAbort, post } from "./api.js";
import { blamed } from "./places.js";

/**
 * Holds the last answer of a route to the design at hand. One request is under way, the newest
 * design waits. The route is {path, tab, isWanted(tree), fieldOf(path)}: its address, the tab where
 * the answer is seen, whether a design has such an answer, and the control that a path of the
 * server belongs to. `told` is called after every change.
 */
export class Asker {
  constructor(app, route, told) {
    this.app = app;
    this.route = route;
    this.told = told;
    this.answer = null; // {key, tree, result}
    this.failure = null; // {key, error}
    this.wanted = null;
    this.isAsking = false;
    app.store.listen((state, why) => this.heard(state, why));
  }

  /** A slider that moves is followed only where the answer is looked at. */
  heard({ case: tree, view }, why) {
    const { isWanted, tab } = this.route;
    this.wanted = isWanted(tree) ? tree : null;
    if (!this.wanted) this.failure = null;
    else if (why !== "live" || view.tab === tab) this.ask();
    this.told();
  }

  /** The answer to a design, where it is there; null otherwise. */
  of(tree) {
    return this.route.isWanted(tree) && this.answer?.key === keyOf(tree) ? this.answer.result : null;
  }

  /** Why a design has no answer, where that was said: {message, details}; null otherwise. */
  failureOf(tree) {
    return this.route.isWanted(tree) && this.failure?.key === keyOf(tree) ? this.failure.error : null;
  }

  /** Whether a design has its answer, was refused, or needs none. */
  isDone(tree) {
    return Boolean(!this.route.isWanted(tree) || this.of(tree) || this.failureOf(tree));
  }

  async ask() {
    if (this.isAsking) return;
    this.isAsking = true;
    try {
      while (this.wanted && !this.isDone(this.wanted)) await this.once();
    } finally {
      this.isAsking = false;
    }
  }

  async once() {
    const tree = this.wanted;
    const key = keyOf(tree);
    try {
      this.answer = { key, tree, result: await post(this.route.path, tree) };
      this.failure = null;
    } catch (error) {
      if (isAbort(error)) return;
      const { fieldOf = (path) => path } = this.route;
      const details = (error.details ?? []).map((one) => blamed({ ...one, path: fieldOf(one.path ?? "") }, tree));
      this.failure = { key, error: { message: error.message, details } };
    }
    this.told();
  }
}

function keyOf(tree) {
  return JSON.stringify({ ...tree, title: "" });
}
