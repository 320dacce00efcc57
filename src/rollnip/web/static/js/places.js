// Where a complaint of the server belongs, by the labels of the inputs.

import { placeInWords } from "./paths.js";
import { inputAt, withinText } from "./quantities.js";
import { inWords } from "./said.js";
import { say } from "./texts.js";

/** A complaint at an input that the page shows: a free drive has no traction, but its sheet is pulled. */
export function blamed(complaint, tree) {
  const isHidden = complaint.path === "nip.traction" && tree.nip.traction === undefined && tree.sheet;
  return isHidden ? { ...complaint, path: "sheet.tension_in" } : complaint;
}

/** "upper.layers[0].thickness" -> "Upper roller, layer 1, thickness: ", by the labels of the page. */
export function placeSaid(path, tree) {
  const { label } = inputAt(path, tree);
  if (!label) return placeInWords(path);
  const where = placeInWords(ownerOf(path)).replace(/: $/, "");
  return where ? `${where}, ${withinText(label)}: ` : `${label}: `;
}

/** The roller and layer, or the sheet, that an input is of; what it is part of there says its label. */
function ownerOf(path) {
  return path.match(/^(?:upper|lower)(?:\.layers\[\d+\])?|^sheet/)?.[0] ?? "";
}

/** Why the design at hand is refused; while a box holds what cannot be read, that it does. */
export function refused(failure, tree, app) {
  return app.inputs.isUnread() ? sentence(say("refuse.unread")) : complaintsOf(failure, tree, app.units()).join(" ");
}

function sentence(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/** What went wrong with a design: each complaint behind its input, in the words and units of the page. */
export function complaintsOf({ message, details = [] }, tree, units) {
  if (details.length === 0) return [inWords(message, "", units)];
  return details.map(({ path, message: text }) => placeSaid(path ?? "", tree) + inWords(text, path, units, inputAt(path ?? "", tree)));
}
