// Making and finding elements. Nothing here ever reads HTML from a string.

const SVG = "http://www.w3.org/2000/svg";

/** An element: `el("p", { class: "hint", text: "..." }, child, ...)`; `on` holds its listeners. */
export function el(tag, attributes = {}, ...children) {
  return fill(document.createElement(tag), attributes, children);
}

/** The same in SVG. */
export function svg(tag, attributes = {}, ...children) {
  return fill(document.createElementNS(SVG, tag), attributes, children);
}

function fill(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name === "text") node.textContent = value;
    else if (name === "on")
      for (const [event, act] of Object.entries(value)) node.addEventListener(event, act);
    else node.setAttribute(name, value === true ? "" : String(value));
  }
  node.append(...children.filter((child) => child !== null && child !== undefined));
  return node;
}

/** The element of an id; an error where the page has none. */
export function byId(id) {
  const node = document.getElementById(id);
  if (!node) throw new Error(`The page has no element #${id}.`);
  return node;
}

/** A number with its unit, the unit set smaller. */
export function withUnit({ text, unit }) {
  if (!unit) return [text];
  return [text, el("span", { class: "unit", text: unit === "%" ? "\u202f%" : ` ${unit}` })];
}

/** A button of the house; its content is a text or a pictogram. */
export function button(content, act, { kind = "", label = null, id = null, disabled = false } = {}) {
  const attributes = {
    type: "button",
    class: `button ${kind}`.trim(),
    id,
    disabled,
    "aria-label": label,
    title: label,
  };
  return el("button", { ...attributes, on: { click: act } }, content);
}

/** A select with its label; `options` are [value, text] pairs or {group, options}. */
export function select({ id, label, options, value, act }) {
  const box = el("select", { id, on: { change: () => act(box.value) } });
  for (const option of options) box.append(optionOf(option));
  box.value = value;
  return el("div", { class: "field" }, el("label", { for: id, text: label }), box);
}

function optionOf(option) {
  if (Array.isArray(option)) return el("option", { value: option[0], text: option[1] });
  return el("optgroup", { label: option.group }, ...option.options.map(optionOf));
}

/** A checkbox with its label. */
export function checkbox(id, text, value, act) {
  const box = el("input", { type: "checkbox", id, on: { change: () => act(box.checked) } });
  box.checked = value;
  return el("label", { class: "row", for: id }, box, text);
}

/** Say something once: shown for some seconds, and read out. */
export function toast(text) {
  const box = byId("toast");
  box.textContent = text;
  clearTimeout(Number(box.dataset.timer));
  box.dataset.timer = setTimeout(() => {
    box.textContent = "";
  }, 4500);
}
