// Places in a case: "upper.layers[0].material.shore_a". Trees are never changed, only copied.

import { say, sayOr } from "./texts.js";

const TITLES = { sheet: "sheet.title", face: "face.title", heat: "heat.title" };

/** The steps of a path: ["upper", "layers", 0, "material", "shore_a"]. */
export function steps(path) {
  const found = path.match(/[^.[\]]+/g) ?? [];
  return found.map((step) => (/^\d+$/.test(step) ? Number(step) : step));
}

/** What stands at a path, or undefined. */
export function getAt(tree, path) {
  return steps(path).reduce(
    (node, step) => (node === null || node === undefined ? undefined : node[step]),
    tree,
  );
}

/** A copy of the tree with a value at the path; `undefined` takes the key away. */
export function setAt(tree, path, value) {
  return put(tree, steps(path), value);
}

function put(node, [step, ...rest], value) {
  if (step === undefined) return value;
  const copy = Array.isArray(node) ? [...node] : { ...node };
  const next = put(copy[step] ?? (typeof rest[0] === "number" ? [] : {}), rest, value);
  if (rest.length === 0 && value === undefined) delete copy[step];
  else copy[step] = next;
  return copy;
}

/** A path as an id of the page. */
export function idOf(path) {
  return `in-${steps(path).join("-")}`;
}

/** "upper.layers[0].thickness" -> "Upper roller, layer 1, thickness: "; "" for no path. */
export function placeInWords(path) {
  const parts = steps(path ?? "").filter((step) => step !== "nip" && step !== "model");
  const words = parts.map((step, i) => {
    if (typeof step === "number") return null;
    if (step === "upper" || step === "lower") return say(`roller.${step}`);
    if (step in TITLES) return say(TITLES[step]);
    const next = parts[i + 1];
    if (typeof next === "number") return say("path.numbered", { name: named(step.replace(/s$/, "")), number: next + 1 });
    return named(step);
  });
  const text = words.filter(Boolean).join(", ");
  return text ? `${text.charAt(0).toUpperCase()}${text.slice(1)}: ` : "";
}

/** A key of the case file as a word. */
function named(step) {
  return sayOr(`path.${step}`, step.replace(/_/g, " "));
}

/** Whether two trees hold the same. */
export function same(one, two) {
  return canonical(one) === canonical(two);
}

function canonical(tree) {
  return JSON.stringify(tree, (_key, value) => {
    const isTable = value && typeof value === "object" && !Array.isArray(value);
    return isTable ? Object.fromEntries(Object.entries(value).sort(([a], [b]) => (a < b ? -1 : 1))) : value;
  });
}
