// Pictograms, drawn in the colour of the text.

import { svg } from "./dom.js";

const PATHS = {
  undo: "M6.5 3.5 3 7l3.5 3.5M3 7h6.5a3.5 3.5 0 0 1 0 7H7",
  redo: "M9.5 3.5 13 7l-3.5 3.5M13 7H6.5a3.5 3.5 0 0 0 0 7H9",
  up: "M8 13V3.5M4 7.5l4-4 4 4",
  down: "M8 3v9.5M4 8.5l4 4 4-4",
  copy: "M6 6V3.5h7V10h-2.5M3 6h7.5v7.5H3z",
  swap: "M5 13V3M2 6l3-3 3 3M11 3v10M8 10l3 3 3-3",
  remove: "M4 4l8 8M12 4l-8 8",
  theme: "M8 2.5a5.5 5.5 0 1 0 0 11zM8 2.5a5.5 5.5 0 0 1 0 11",
};

/** A pictogram by name; it says nothing to a screen reader, so its button needs a label. */
export function icon(name) {
  const half =
    name === "theme" ? svg("path", { d: "M8 2.5a5.5 5.5 0 1 0 0 11z", fill: "currentColor" }) : null;
  const stroke = {
    fill: "none",
    stroke: "currentColor",
    "stroke-width": 1.6,
    "stroke-linecap": "round",
    "stroke-linejoin": "round",
  };
  const node = svg("svg", {
    viewBox: "0 0 16 16",
    width: 17,
    height: 17,
    "aria-hidden": "true",
    ...stroke,
  });
  node.append(svg("path", { d: PATHS[name] }), ...(half ? [half] : []));
  return node;
}
