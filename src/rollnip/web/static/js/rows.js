// Lists inside a material: terms of a Prony series, points of a table of shifts.

import { button, el } from "./dom.js";
import { icon } from "./icons.js";
import { getAt, idOf, setAt } from "./paths.js";
import { say } from "./texts.js";

/**
 * The rows of the list at `path`: a control for each of `names` and a button that removes the row,
 * down to `fewest`; below them one that adds `next(last)`. `kind` is "term" or "point".
 */
export function rowsEditor(path, { kind, names, fewest, next }, panel) {
  const list = getAt(panel.app.store.state.case, path);
  const put = (changed) => panel.change(setAt(panel.app.store.state.case, path, changed));
  const stem = idOf(path);
  const rows = list.map((_one, i) => {
    const drop = button(icon("remove"), () => put(list.filter((_row, j) => j !== i)), {
      kind: "icon",
      label: say(`material.remove-${kind}`, { number: i + 1 }),
      id: `${stem}-drop-${i}`,
      disabled: list.length <= fewest,
    });
    const [first, ...others] = names.map((name) => panel.control(`${path}[${i}].${name}`));
    const label = say(`material.${kind}`, { number: i + 1 });
    return el("div", { class: "term", role: "group", "aria-label": label }, first, drop, ...others);
  });
  const add = button(say(`material.add-${kind}`), () => put([...list, next(list[list.length - 1])]), {
    kind: "small",
    id: `${stem}-add`,
  });
  return el("div", { class: "inner" }, ...rows, add);
}
