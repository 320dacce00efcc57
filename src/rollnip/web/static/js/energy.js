// The strain energy of a material: how its stiffness goes on at large strain.

import { select } from "./dom.js";
import { getAt, idOf, setAt } from "./paths.js";
import { rowsEditor } from "./rows.js";
import { say } from "./texts.js";

const USUAL = "neo-hookean";
const ENERGIES = {
  [USUAL]: undefined,
  yeoh: { model: "yeoh", second: -0.02, third: 0.0005 },
  gent: { model: "gent", limit: 30 },
  ogden: { model: "ogden", terms: [{ weight: 1, exponent: 2 }] },
};
const NUMBERS = { yeoh: ["second", "third"], gent: ["limit"] };
const TERMS = {
  kind: "term",
  names: ["weight", "exponent"],
  fewest: 1,
  next: ({ exponent }) => ({ weight: 0.1, exponent: -exponent }),
};

/** The elements that choose the strain energy of the material at `path`; `panel` is the Inputs. */
export function energyEditor(path, panel) {
  const place = `${path}.energy`;
  const energy = getAt(panel.app.store.state.case, place);
  const kind = energy?.model ?? USUAL;
  const law = energy?.volumetric ? { volumetric: energy.volumetric } : {};
  const act = (wanted) => {
    const made = ENERGIES[wanted] ?? (energy?.volumetric ? { model: USUAL } : undefined);
    const { case: tree } = panel.app.store.state;
    panel.change(setAt(tree, place, made && { ...structuredClone(made), ...law }));
  };
  return [
    select({
      id: idOf(place),
      label: say("energy.label"),
      options: Object.keys(ENERGIES).map((name) => [name, say(`energy.${name}`)]),
      value: kind,
      act,
    }),
    ...(NUMBERS[kind] ?? []).map((name) => panel.control(`${place}.${name}`)),
    kind === "ogden" ? rowsEditor(`${place}.terms`, TERMS, panel) : null,
  ];
}
