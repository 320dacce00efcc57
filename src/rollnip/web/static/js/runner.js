// Asks the server for answers so that the newest design wins and slow ones are still seen.

import { isAbort, post, solved } from "./api.js";
import { quickCase } from "./design.js";

/**
 * While a slider moves: previews, one under way and the newest waiting. At rest: the design as it
 * stands, one exact answer under way and the newest waiting, then its surfaces. What is begun for
 * a moving slider is finished and told, however long it takes, unless a newer answer is there. Any
 * other change gives up what is under way. `tell` is {preview, settled, surfaces, failed, busy},
 * functions called with what came.
 */
export class Runner {
  constructor(tell) {
    this.tell = tell;
    this.count = 0; // designs asked for
    this.told = 0; // number of the newest design with an answer
    this.flight = null; // AbortController of the preview under way
    this.moving = null; // {tree, number} of the newest preview that waits
    this.exact = null; // AbortController of the exact answer under way
    this.resting = null; // {tree, number} of the newest design at rest that waits
  }

  /** The design moves. */
  preview(tree) {
    this.moving = this.next(tree);
    if (!this.flight) this.launch();
  }

  /** The design rests; `moved` where a slider brought it there. */
  settle(tree, moved) {
    const one = this.next(tree);
    this.tell.busy(true);
    if (!moved) {
      this.moving = null;
      this.flight?.abort();
      this.exact?.abort();
      this.exact = null;
    }
    this.resting = one;
    if (!this.exact) this.land();
  }

  /** Whether an answer is under way. */
  get isBusy() {
    return Boolean(this.exact || this.flight);
  }

  next(tree) {
    this.count += 1;
    return { tree, number: this.count };
  }

  /** Whether an answer is newer than what is shown; it counts as told then. */
  isNews({ number }) {
    if (number < this.told) return false;
    this.told = number;
    return true;
  }

  async land() {
    const one = this.resting;
    const exact = new AbortController();
    this.resting = null;
    this.exact = exact;
    try {
      const result = await solved(one.tree, exact.signal);
      if (this.isNews(one)) {
        this.tell.settled(one.tree, result);
        this.tell.surfaces(one.tree, await post("/api/surfaces", one.tree, exact.signal), result);
      }
    } catch (error) {
      if (!isAbort(error) && this.isNews(one)) this.tell.failed(one.tree, error);
    } finally {
      if (this.exact === exact) {
        this.exact = null;
        if (this.resting) this.land();
        else this.tell.busy(false);
      }
    }
  }

  async launch() {
    const one = this.moving;
    const flight = new AbortController();
    this.moving = null;
    this.flight = flight;
    try {
      const quick = quickCase(one.tree);
      const result = await solved(quick, flight.signal);
      if (this.isNews(one)) {
        this.tell.preview(one.tree, result);
        if (one.number === this.count) this.sections(one, quick, result);
      }
    } catch (error) {
      if (!isAbort(error) && this.isNews(one)) this.tell.failed(one.tree, error);
    } finally {
      if (this.flight === flight) this.flight = null;
      if (this.moving && this.moving.number > this.told) this.launch();
    }
  }

  /** The surfaces of a preview, where no newer one is on its way. */
  async sections(one, quick, result) {
    try {
      const surfaces = await post("/api/surfaces", quick);
      if (one.number === this.count) this.tell.surfaces(one.tree, surfaces, result);
    } catch (error) {
      if (!isAbort(error) && one.number === this.count) this.tell.failed(one.tree, error);
    }
  }
}
