// Designs the user saved, in the storage of this browser. A link never touches them.

const KEY = "rollnip.designs";
const MOST = 100;

/** [{name, case}], newest first. */
export function savedDesigns() {
  try {
    const list = JSON.parse(localStorage.getItem(KEY) ?? "[]");
    return Array.isArray(list) ? list.filter((one) => one && typeof one.name === "string" && one.case) : [];
  } catch {
    return [];
  }
}

/** Put a design in front; one of the same name gives way. Throws where the browser keeps nothing. */
export function saveDesign(name, tree) {
  const others = savedDesigns().filter((one) => one.name !== name);
  localStorage.setItem(KEY, JSON.stringify([{ name, case: tree }, ...others].slice(0, MOST)));
}

export function removeDesign(name) {
  localStorage.setItem(KEY, JSON.stringify(savedDesigns().filter((one) => one.name !== name)));
}

/** How this browser wants the page to be ("system", "language", ...); null where it never said. */
export function remembered(what) {
  try {
    return localStorage.getItem(`rollnip.${what}`);
  } catch {
    return null;
  }
}

export function remember(what, value) {
  try {
    localStorage.setItem(`rollnip.${what}`, value);
  } catch {
    // Without storage it holds for this page only.
  }
}
