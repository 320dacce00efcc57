// The two drawings beside the big figure.

import { el } from "./dom.js";
import { pairPicture } from "./drawing.js";
import { sectionCaption, sectionPicture, windowOf } from "./section.js";
import { say } from "./texts.js";

const SHAPES = { pair: 1.6, nip: 0.9 }; // height over width
const TALLEST = 300;

/** Redraws in the size they have. */
export class Drawings {
  constructor(place, app) {
    this.app = app;
    this.pair = el("div");
    this.nip = el("div");
    this.pairText = el("figcaption", { text: say("drawing.pair") });
    this.nipText = el("figcaption", { text: say("drawing.nip") });
    place.replaceChildren(
      el("figure", { class: "whole" }, this.pair, this.pairText),
      el("figure", { class: "zoom" }, this.nip, this.nipText),
    );
    new ResizeObserver(() => this.shown && this.show(this.shown)).observe(place);
  }

  show(snapshot) {
    this.shown = snapshot;
    const { tree, result, surfaces } = snapshot;
    const look = { palette: this.app.palette(), units: this.app.units() };
    const half = windowOf(result);
    this.pair.replaceChildren(
      pairPicture(tree, result, half, { ...look, ...sizeIn(this.pair, SHAPES.pair) }),
    );
    this.pairText.textContent = say(tree.sheet ? "drawing.pair-sheet" : "drawing.pair");
    if (!surfaces) return;
    const size = sizeIn(this.nip, SHAPES.nip);
    this.nip.replaceChildren(sectionPicture(tree, result, surfaces, { ...look, ...size }));
    this.nipText.textContent = sectionCaption(tree, result, size.width);
  }
}

function sizeIn(node, shape) {
  const width = node.clientWidth || 320;
  return { width, height: Math.round(Math.min(TALLEST, shape * width)) };
}
