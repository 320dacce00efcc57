// Designs from outside: those of links, and the last one of this browser. The newest one asked for wins.

import { post, sentencesOf } from "./api.js";
import { underway } from "./busy.js";
import { MOST_KEPT } from "./compare.js";
import { designOf } from "./design.js";
import { byId } from "./dom.js";
import { patchOf } from "./patch.js";
import { stateIn } from "./permalink.js";
import { remembered } from "./saved.js";
import { say } from "./texts.js";
import { viewOf } from "./view.js";

/** Opens designs into `this.store`; the App says what goes wrong. */
export class Opening {
  constructor() {
    this.turn = 0; // how many designs were begun to be opened
  }

  /** Begin with the state of an address, or with the default nip. */
  begin(hash) {
    return underway("opening", this.beginWith(hash));
  }

  async beginWith(hash) {
    const isNewest = this.opening();
    try {
      const state = await stateIn(hash);
      if (state !== undefined) return await this.restore(state, isNewest);
      if (!this.snapshot && (await this.resumed(isNewest))) return undefined;
    } catch (error) {
      return isNewest() ? this.refuseLink(sentencesOf(error).slice(0, 3).join(" ")) : undefined;
    }
    return isNewest() ? this.changed(this.store.state, "design") : undefined;
  }

  /** A design is going to be opened; return what says whether it is still the one asked for last. */
  opening() {
    const turn = (this.turn += 1);
    return () => turn === this.turn;
  }

  /** Go on with the last design of this browser; false where there is none. */
  async resumed(isNewest) {
    const last = remembered("last");
    if (!last) return false;
    try {
      await this.restore(JSON.parse(last), isNewest);
      return true;
    } catch {
      return false; // of an older version, or damaged: begin anew
    }
  }

  /** No answer is shown that one might take for that of the link. */
  refuseLink(why) {
    this.broken = why;
    this.failure = null;
    this.complain(`${say("link.title")}: ${why}`);
    this.changed(this.store.state, "view");
    if (!this.snapshot) byId("big").textContent = "–";
    document.documentElement.dataset.state = "rest";
  }

  /** A state from outside: every case goes through the server's check first. */
  async restore(state, isNewest = this.opening()) {
    const { case: tree, kept: others = [] } = state ?? {};
    if (!tree || !Array.isArray(others)) throw new Error(say("link.empty"));
    const first = await this.checked(tree);
    const read = await Promise.allSettled(others.slice(0, MOST_KEPT).map((one) => this.checked(one)));
    const kept = read.filter(({ status }) => status === "fulfilled").map(({ value }) => value);
    const lost = read.filter(({ status }) => status === "rejected");
    if (!isNewest()) return;
    this.isPristine = false;
    const view = viewOf(state);
    this.store.replace({ case: first, kept, patch: patchOf(state.patch, view.system), view });
    if (lost.length === 0) return;
    const why = sentencesOf(lost[0].reason)[0];
    this.complain(say("link.kept", { count: lost.length, why }));
  }

  async checked(tree) {
    return designOf((await post("/api/case", tree)).case);
  }
}
