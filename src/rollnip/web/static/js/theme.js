// Light or dark: as the system says, until the user says otherwise.

const KEY = "rollnip.theme";

/** Keeps the theme on the root element and tells `listener` of changes. */
export class Theme {
  constructor(listener) {
    this.listener = listener;
    this.system = matchMedia("(prefers-color-scheme: dark)");
    this.system.addEventListener("change", () => this.apply());
    this.apply();
  }

  get name() {
    return stored() ?? (this.system.matches ? "dark" : "light");
  }

  toggle() {
    const next = this.name === "dark" ? "light" : "dark";
    try {
      localStorage.setItem(KEY, next);
    } catch {
      // Without storage the choice holds for this page only.
    }
    this.apply(next);
  }

  apply(name = this.name) {
    document.documentElement.dataset.theme = name;
    this.listener(name);
  }
}

function stored() {
  try {
    const name = localStorage.getItem(KEY);
    return name === "light" || name === "dark" ? name : null;
  } catch {
    return null;
  }
}
