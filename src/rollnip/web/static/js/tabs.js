// Tabs by the book: arrows move, only the chosen one is in the order of Tab.

import { byId, el } from "./dom.js";

/** The tabs over `views` ({id, title, node, show}). */
export class Tabs {
  constructor(views, app) {
    this.views = views;
    this.app = app;
    this.buttons = new Map(views.map((view) => [view.id, this.tab(view)]));
    byId("tabs").replaceChildren(...this.buttons.values());
    byId("tabs").addEventListener("keydown", (event) => this.move(event));
  }

  tab({ id, title }) {
    const choose = () => this.app.store.view({ tab: id });
    return el("button", {
      type: "button",
      role: "tab",
      id: `tab-${id}`,
      "aria-controls": "panel",
      text: title,
      on: { click: choose },
    });
  }

  /** The view that is open. */
  get open() {
    const { tab } = this.app.store.state.view;
    return this.views.find(({ id }) => id === tab) ?? this.views[0];
  }

  /** Put the open view into the panel. */
  refresh() {
    const view = this.open;
    for (const [id, button] of this.buttons) {
      button.setAttribute("aria-selected", String(id === view.id));
      button.tabIndex = id === view.id ? 0 : -1;
    }
    const panel = byId("panel");
    panel.setAttribute("aria-labelledby", `tab-${view.id}`);
    if (panel.firstChild === view.node) return;
    panel.replaceChildren(view.node);
    bringIntoView(this.buttons.get(view.id));
  }

  move(event) {
    const order = this.views.map(({ id }) => id);
    const at = order.indexOf(this.open.id);
    const next = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: order.length - 1 }[event.key];
    if (next === undefined) return;
    event.preventDefault();
    const id = order[(next + order.length) % order.length];
    this.app.store.view({ tab: id });
    this.buttons.get(id).focus();
  }
}

/** Scroll the bar of tabs, where it is longer than its window, so far that a tab is seen. */
function bringIntoView(button) {
  const bar = button.parentElement;
  const [box, frame] = [button.getBoundingClientRect(), bar.getBoundingClientRect()];
  if (box.left < frame.left || box.right > frame.right)
    bar.scrollLeft += box.left - frame.left - 0.5 * (frame.width - box.width);
}
