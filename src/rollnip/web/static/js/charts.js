// Plotly: loaded once from the server itself, drawn in the colours of the theme.

import { underway } from "./busy.js";
import { say } from "./texts.js";

const SOURCE = "/static/plotly.min.js";
const TYPE = "Inter, 'Segoe UI', system-ui, -apple-system, Roboto, sans-serif";
const NARROW = 520; // px
const CONFIG = { displayModeBar: false, responsive: false, displaylogo: false, doubleClick: "reset" };

let loading = null; // the page has one Plotly

/** Plotly, fetched when it is first needed. */
export function plotly() {
  loading ??= new Promise((resolve, reject) => {
    const script = document.createElement("script");
    script.src = SOURCE;
    script.addEventListener("load", () => resolve(globalThis.Plotly));
    script.addEventListener("error", () => reject(new Error(say("chart.unloaded"))));
    document.head.append(script);
  });
  return loading;
}

/** A chart in a node of its own; the newest figure wins while Plotly still loads. */
export class Chart {
  constructor(node) {
    this.node = node;
    this.node.setAttribute("role", "img");
    this.node.setAttribute("aria-label", say("chart.undrawn"));
    this.figure = null;
    this.drawn = Promise.resolve();
    new ResizeObserver(() => this.fit()).observe(node);
  }

  /** Draw {data, layout, label}. */
  show(figure) {
    this.figure = figure;
    this.node.setAttribute("aria-label", figure.label);
    return underway("drawing", this.draw(figure));
  }

  async draw(figure) {
    const Plotly = await plotly();
    if (this.figure !== figure || !this.node.isConnected) return;
    const named = figure.data.filter(({ name, showlegend }) => name && showlegend !== false);
    this.node.style.setProperty("--names", named.length); // a narrow chart is as much higher
    await Plotly.react(this.node, figure.data, sized(figure.layout, this.node), CONFIG);
    this.node.dispatchEvent(new CustomEvent("drawn"));
  }

  fit() {
    const drawn = this.node._fullLayout;
    const { clientWidth: width, clientHeight: height } = this.node;
    if (!drawn || !width || (drawn.width === width && drawn.height === height)) return;
    this.show({ ...this.figure });
  }
}

/** A layout for the size of its node; where that is narrow, type is smaller and long titles break. */
function sized(layout, node) {
  const { clientWidth: width, clientHeight: height } = node;
  if (width > NARROW) return { ...layout, width, height };
  const broken = (axis) => ({
    ...axis,
    title: { ...axis.title, text: axis.title.text.replace(", ", "<br>") },
  });
  const font = { ...layout.font, size: 11 };
  const legend = { ...layout.legend, font: { size: 11 } };
  return {
    ...layout,
    width,
    height,
    font,
    legend,
    xaxis: broken(layout.xaxis),
    margin: { l: 50, r: 8, t: 8, b: 54 },
  };
}

/** Layout shared by all charts; `along` is the unit of x where the hover text is one for all lines. */
export function layoutOf(palette, x, y, { along = "", ...more } = {}) {
  const axis = (title) => ({
    title: { text: title, standoff: 8 },
    gridcolor: palette.grid,
    zerolinecolor: palette.bound,
    zerolinewidth: 1,
    linecolor: palette.bound,
    automargin: true,
    exponentformat: "power", // 10⁹, not 1B
    fixedrange: true,
  });
  const { xaxis = {}, yaxis = {}, ...rest } = more;
  return {
    margin: { l: 62, r: 14, t: 12, b: 48 },
    font: { family: TYPE, size: 13, color: palette.ink },
    paper_bgcolor: palette.ground,
    plot_bgcolor: palette.ground,
    xaxis: { ...axis(x), unifiedhovertitle: { text: `%{x:.4~g} ${along}`.trim() }, ...xaxis },
    yaxis: { ...axis(y), ...yaxis },
    legend: {
      orientation: "h",
      x: 0,
      y: 1.02,
      yanchor: "bottom",
      font: { size: 12.5 },
      bgcolor: "rgba(0,0,0,0)",
      itemclick: false,
      itemdoubleclick: false,
    },
    hovermode: "x unified",
    hoverlabel: {
      bgcolor: palette.ground,
      bordercolor: palette.bound,
      font: { color: palette.ink, size: 12.5 },
    },
    ...rest,
  };
}

/** A line of a chart. */
export function line(name, x, y, colour, more = {}) {
  const { dash = "solid", width = 2.2, ...rest } = more;
  return {
    type: "scatter",
    mode: "lines",
    name: plain(name),
    x,
    y,
    // Plotly would leave out points of smooth curves; there are a few hundred.
    line: { color: colour, width, dash, simplify: false },
    connectgaps: false,
    ...rest,
  };
}

/** Text that Plotly shall not read as markup. */
export function plain(text) {
  return text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;");
}

/** An axis title with its unit. */
export function titled(text, unit) {
  return unit ? `${text} [${unit}]` : text;
}

/** The figure as an SVG element, at once. Throws where Plotly is not loaded yet. */
export function svgOf(figure, width, height) {
  const { Plotly } = globalThis;
  if (!Plotly) throw new Error(say("chart.undrawn"));
  const place = document.createElement("div");
  place.className = "offstage";
  document.body.append(place);
  const drawing = Plotly.newPlot(place, figure.data, { ...figure.layout, width, height }, { staticPlot: true });
  drawing.finally(() => {
    Plotly.purge(place);
    place.remove();
  });
  const text = Plotly.Snapshot.toSVG(place, "svg");
  const node = new DOMParser().parseFromString(text, "image/svg+xml").documentElement;
  node.setAttribute("viewBox", `0 0 ${width} ${height}`);
  return document.importNode(node, true);
}

/** The figure as a data URL, "svg" or "png", whatever is on the page. */
export async function image(figure, format, { width = 900, height = 500, scale = 2 } = {}) {
  const Plotly = await plotly();
  const layout = { ...figure.layout, width, height };
  return Plotly.toImage(
    { data: figure.data, layout },
    { format, width, height, scale: format === "png" ? scale : 1 },
  );
}
