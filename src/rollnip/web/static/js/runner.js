// Asks the server for answers so that the latest design always wins.

import { SOLVE, isAbort, post } from "./api.js";
import { quickCase } from "./design.js";

const PATIENCE = 400; // ms after which a running preview gives way to a newer one

/**
 * While a slider moves: previews, one under way and the newest waiting, so nothing queues up.
 * At rest: the design as it stands, then its surfaces. `tell` is {preview, settled, surfaces,
 * failed, busy}, functions called with what came.
 */
export class Runner {
  constructor(tell) {
    this.tell = tell;
    this.flight = null; // {abort, started} of the preview under way
    this.waiting = null; // the newest design that waits for it
    this.exact = null; // AbortController of the exact answer under way
    this.turn = 0;
  }

  /** The design moves. */
  preview(tree) {
    this.exact?.abort();
    this.waiting = tree;
    if (!this.flight) this.launch();
    else if (performance.now() - this.flight.started > PATIENCE) this.flight.abort.abort();
  }

  /** The design rests: the exact answer. */
  async settle(tree) {
    this.waiting = null;
    this.flight?.abort.abort();
    this.exact?.abort();
    const exact = new AbortController();
    this.exact = exact;
    this.turn += 1;
    this.tell.busy(true);
    try {
      const result = await post(SOLVE, tree, exact.signal);
      this.tell.settled(tree, result);
      this.tell.surfaces(tree, await post("/api/surfaces", tree, exact.signal), result);
    } catch (error) {
      if (!isAbort(error)) this.tell.failed(tree, error);
    } finally {
      if (this.exact === exact) {
        this.exact = null;
        this.tell.busy(false);
      }
    }
  }

  async launch() {
    const tree = this.waiting;
    const flight = { abort: new AbortController(), started: performance.now() };
    const turn = this.turn;
    this.waiting = null;
    this.flight = flight;
    try {
      const quick = quickCase(tree);
      const result = await post(SOLVE, quick, flight.abort.signal);
      if (turn === this.turn) this.tell.preview(tree, result);
      if (!this.waiting && turn === this.turn) this.sections(tree, quick, result, turn);
    } catch (error) {
      if (!isAbort(error) && turn === this.turn) this.tell.failed(tree, error);
    } finally {
      this.flight = null;
      if (this.waiting) this.launch();
    }
  }

  /** The surfaces of a preview, where no newer one is on its way. */
  async sections(tree, quick, result, turn) {
    try {
      const surfaces = await post("/api/surfaces", quick);
      if (turn === this.turn && !this.waiting) this.tell.surfaces(tree, surfaces, result);
    } catch (error) {
      if (!isAbort(error) && turn === this.turn) this.tell.failed(tree, error);
    }
  }
}
