// Asks the server for the face of a design; the newest design wins.

import { isAbort, post } from "./api.js";

const FIELDS = [
  [/\.shaft\.crown$/, ".shaft.crown.height"],
  [/^face\.end_loads$/, "face.end_loads[0]"],
];

/** Holds the last face: {tree, face}. One request is under way, the newest design waits. */
export class FaceRunner {
  constructor(app, told) {
    this.app = app;
    this.told = told;
    this.answer = null; // {key, tree, face}
    this.failure = null; // {key, error}
    this.wanted = null;
    this.isAsking = false;
    app.store.listen((state, why) => this.heard(state, why));
  }

  /** A slider that moves is followed only where the face is looked at. */
  heard({ case: tree, view }, why) {
    this.wanted = tree.face ? tree : null;
    if (!tree.face) this.failure = null;
    else if (why !== "live" || view.tab === "face") this.ask();
    this.told();
  }

  /** The face of a design, where it is there; null otherwise. */
  of(tree) {
    return tree.face && this.answer?.key === keyOf(tree) ? this.answer.face : null;
  }

  /** Why a design has no face, where that was said: {message, details}; null otherwise. */
  failureOf(tree) {
    return tree.face && this.failure?.key === keyOf(tree) ? this.failure.error : null;
  }

  async ask() {
    if (this.isAsking) return;
    this.isAsking = true;
    try {
      while (this.wanted && !this.of(this.wanted) && !this.failureOf(this.wanted)) await this.once();
    } finally {
      this.isAsking = false;
    }
  }

  async once() {
    const tree = this.wanted;
    const key = keyOf(tree);
    try {
      this.answer = { key, tree, face: await post("/api/face", tree) };
      this.failure = null;
    } catch (error) {
      if (isAbort(error)) return;
      const details = (error.details ?? []).map((one) => ({ ...one, path: fieldOf(one.path) }));
      this.failure = { key, error: { message: error.message, details } };
    }
    this.told();
  }
}

/** The control that a path of the server belongs to. */
function fieldOf(path) {
  return FIELDS.reduce((text, [found, field]) => text.replace(found, field), path ?? "");
}

function keyOf(tree) {
  return JSON.stringify({ ...tree, title: "" });
}
