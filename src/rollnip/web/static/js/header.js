// The header: its buttons and menus, shortcuts, links pasted into the address.

import { byId } from "./dom.js";
import { icon } from "./icons.js";
import { designItems, menu, shareItems } from "./menus.js";
import { setAt } from "./paths.js";
import { say } from "./texts.js";

/** Have the header, the shortcuts and the address act on the app. */
export function wireHeader(app) {
  const { store } = app;
  for (const id of ["undo", "redo", "theme"]) byId(id).append(icon(id));
  byId("undo").addEventListener("click", () => store.undo());
  byId("redo").addEventListener("click", () => store.redo());
  for (const system of ["metric", "us"]) byId(system).addEventListener("click", () => app.measure(system));
  byId("theme").addEventListener("click", () => app.theme.toggle());
  byId("open-examples").addEventListener("click", () => app.examples.showModal());
  menu("open-share", say("menu.share"), shareItems(app));
  menu("open-designs", say("menu.designs"), designItems(app));
  const title = byId("design-title");
  title.addEventListener("change", () =>
    store.design({ case: setAt(store.state.case, "title", title.value.trim()) }),
  );
  addEventListener("keydown", (event) => shortcut(app, event));
  addEventListener("hashchange", ({ newURL }) => app.begin(new URL(newURL).hash));
  new IntersectionObserver(([entry]) =>
    byId("mini").classList.toggle("shown", !entry.isIntersecting),
  ).observe(byId("big"));
}

function shortcut(app, event) {
  const key = event.key.toLowerCase();
  const writes = key !== "p" && event.target.matches?.('input[type="text"], textarea');
  if (writes || !(event.ctrlKey || event.metaKey) || event.altKey) return undefined;
  if (key !== "z" && key !== "y" && key !== "p") return undefined;
  event.preventDefault();
  if (key === "p") return app.report();
  return key === "y" || event.shiftKey ? app.store.redo() : app.store.undo();
}
