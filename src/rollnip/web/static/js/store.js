// The state of the page, who listens to it, and the way back.

const DEEPEST = 200;

/**
 * Holds {case, kept, patch, view}. `case`, `kept` (designs kept for comparison) and `patch` (that of
 * the design in three dimensions, or null) can be undone; how they are looked at cannot. Changes with the same `gesture` (one drag of a slider) are one step.
 */
export class Store {
  constructor(state) {
    this.state = state;
    this.past = [];
    this.future = [];
    this.gesture = null;
    this.listeners = [];
  }

  /** Call `listener(state, why)` after every change; why is "design", "opened", "view", "live" or "rest". */
  listen(listener) {
    this.listeners.push(listener);
  }

  /** Change the design; `gesture` names a movement that still goes on. */
  design(change, gesture = null) {
    if (gesture === null || gesture !== this.gesture) {
      this.past = [...this.past, this.undoable()].slice(-DEEPEST);
      this.future = [];
    }
    this.gesture = gesture;
    this.state = { ...this.state, ...change };
    this.tell(gesture === null ? "design" : "live");
  }

  /** Another state altogether; there is no way back behind it. */
  replace(state) {
    this.past = [];
    this.future = [];
    this.gesture = null;
    this.state = state;
    this.tell("opened");
  }

  /** The movement is over. */
  rest() {
    if (this.gesture === null) return;
    this.gesture = null;
    this.tell("rest");
  }

  /** Change how things are looked at. */
  view(change) {
    this.state = { ...this.state, view: { ...this.state.view, ...change } };
    this.tell("view");
  }

  undo() {
    this.step(this.past, this.future);
  }

  redo() {
    this.step(this.future, this.past);
  }

  step(from, to) {
    if (from.length === 0) return;
    to.push(this.undoable());
    this.gesture = null;
    this.state = { ...this.state, ...from.pop() };
    this.tell("design");
  }

  undoable() {
    const { case: tree, kept, patch } = this.state;
    return { case: tree, kept, patch };
  }

  tell(why) {
    for (const listener of this.listeners) listener(this.state, why);
  }
}
