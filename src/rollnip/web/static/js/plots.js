// The curves along the nip: what each chart shows, as plain data for Plotly.

import { layoutOf, line, titled } from "./charts.js";
import { nameOf } from "./design.js";
import { curveName, figureIn, nipText } from "./quantities.js";
import { say } from "./texts.js";

const ALONG = say("axis.along");
const ENDS = say("axis.ends");
const SIDE = 0.75; // nip widths shown outside the contact

/** The charts by tab: each (result, units, palette, tree) -> {data, layout, label}. */
export const PLOTS = { pressure: pressurePlot, gap: gapPlot, strain: strainPlot, speed: speedPlot, sheet: sheetPlot };

function pressurePlot(result, units, palette, tree) {
  const { profiles } = result;
  const { x, data } = begin(result, units);
  const name = units.name("pressure");
  const pressure = units.list(profiles.pressure, "pressure");
  const shear = units.list(profiles.shear, "pressure");
  data.push(
    line(curveName("profile", "pressure"), x, pressure, palette.pressure, {
      width: 2.6,
      fill: "tozeroy",
      fillcolor: `${palette.pressure}14`,
      hovertemplate: `%{y:.4~g} ${name}`,
    }),
  );
  const curve = curveName("profile", "shear");
  data.push(line(result.sheet ? say("curve.upper", { curve }) : curve, x, shear, palette.shear, { hovertemplate: `%{y:.4~g} ${name}` }));
  const lower = result.sheet ? units.list(result.sheet.profiles.shear_lower, "pressure") : [];
  if (lower.length) {
    const style = { dash: "longdash", hovertemplate: `%{y:.4~g} ${name}` };
    data.push(line(curveName("web", "shear_lower"), x, lower, palette.lower, style));
  }
  const below = result.sheet?.bends ? units.list(result.sheet.profiles.pressure_lower, "pressure") : [];
  if (below.length) {
    const style = { dash: "dashdot", hovertemplate: `%{y:.4~g} ${name}` };
    data.push(line(curveName("web", "pressure_lower"), x, below, palette.pressure, style));
  }
  data.push(...boundsOf(result, tree, units, x, palette));
  const [low, high] = span([...pressure, ...below], [...shear, ...lower]);
  const layout = layoutOf(palette, along(units), titled(say("axis.pressure"), name), {
    along: units.name("length"),
    xaxis: { range: reach(result, units) },
    yaxis: { range: [low, high] },
    shapes: zonesOf(result, units, palette),
  });
  const label = say("chart.pressure", {
    peak: nipText("peak_pressure", result, units),
    nip: nipText("nip_width", result, units),
    zones: zoneWords(result),
  });
  return { data, layout, label };
}

function gapPlot(result, units, palette) {
  const { x, data } = begin(result, units);
  const unit = units.name("length");
  const gap = units.list(result.profiles.gap, "length");
  data.push(line(curveName("profile", "gap"), x, gap, palette.upper, { width: 2.6, hovertemplate: `%{y:.4~g} ${unit}` }));
  const layout = layoutOf(palette, along(units), titled(figureIn("profile", "gap").label, unit), {
    along: units.name("length"),
    xaxis: { range: reach(result, units) },
    yaxis: { rangemode: "tozero", range: upTo(x, gap, reach(result, units)) },
    shapes: contactShape(result, units, palette),
  });
  return {
    data,
    layout,
    label: say("chart.gap", { nip: nipText("nip_width", result, units) }),
  };
}

function strainPlot(result, units, palette) {
  const { x, data } = begin(result, units);
  for (const side of ["upper", "lower"]) {
    const values = units.list(result.profiles[`strain_${side}`], "share");
    data.push(
      line(say(`surface.${side}`), x, values, palette[side], {
        hovertemplate: `%{y:.3~g} ${units.name("share")}`,
        dash: side === "lower" ? "longdash" : "solid",
      }),
    );
  }
  const layout = layoutOf(palette, along(units), titled(say("axis.strain"), units.name("share")), {
    along: units.name("length"),
    xaxis: { range: reach(result, units) },
    shapes: zonesOf(result, units, palette),
  });
  return { data, layout, label: say("chart.strain") };
}

function speedPlot(result, units, palette) {
  const { profiles } = result;
  const { x, data } = begin(result, units);
  if (!profiles.speed_upper) return null;
  const unit = units.name("speed");
  for (const side of ["upper", "lower"]) {
    const values = units.list(profiles[`speed_${side}`], "speed");
    data.push(
      line(say(`surface.${side}`), x, values, palette[side], {
        hovertemplate: `%{y:.5~g} ${unit}`,
        dash: side === "lower" ? "longdash" : "solid",
      }),
    );
  }
  const layout = layoutOf(palette, along(units), titled(say("axis.speed"), unit), {
    along: units.name("length"),
    xaxis: { range: reach(result, units) },
    shapes: zonesOf(result, units, palette),
  });
  return { data, layout, label: say("chart.speed") };
}

/** Friction times pressure, up and down; one for each side of a sheet whose frictions differ. */
function boundsOf(result, tree, units, x, palette) {
  const own = tree.sheet ?? {};
  const upper = own.friction_upper ?? tree.nip.friction;
  const lower = own.friction_lower ?? tree.nip.friction;
  const { pressure } = result.profiles;
  const sides = [["curve.bound", upper, pressure, "dash"]];
  if (result.sheet && upper !== lower) {
    sides[0][0] = "curve.bound-upper";
    sides.push(["curve.bound-lower", lower, result.sheet.profiles.pressure_lower ?? pressure, "dot"]);
  }
  return sides
    .filter(([, friction]) => friction > 0)
    .flatMap(([key, friction, pressed, dash]) => {
      const bound = units.list(pressed, "pressure").map((value) => friction * value);
      const style = { dash, width: 1.3, hoverinfo: "skip", legendgroup: key };
      const below = bound.map((value) => -value);
      return [
        line(say(key), x, bound, palette.bound, style),
        line("", x, below, palette.bound, { ...style, showlegend: false }),
      ];
    });
}

/** Tension of the sheet; strain on an axis of its own. */
function sheetPlot(result, units, palette) {
  if (!result.sheet) return null;
  const { profiles } = result.sheet;
  const x = units.list(profiles.x, "length");
  const unit = units.name("line load");
  const data = [
    line(curveName("web", "tension"), x, units.list(profiles.tension, "line load"), palette.pressure, {
      width: 2.6,
      hovertemplate: `%{y:.4~g} ${unit}`,
    }),
    line(curveName("web", "strain"), x, units.list(profiles.strain, "share"), palette.shear, {
      dash: "dash",
      yaxis: "y2",
      hovertemplate: `%{y:.3~g} ${units.name("share")}`,
    }),
  ];
  const second = { text: titled(figureIn("web", "strain").label, units.name("share")), standoff: 8 };
  const layout = layoutOf(palette, along(units), titled(figureIn("web", "tension").label, unit), {
    along: units.name("length"),
    xaxis: { range: reach(result, units) },
    yaxis2: {
      title: second,
      overlaying: "y",
      side: "right",
      showgrid: false,
      zeroline: false,
      tickmode: "auto",
      tickformat: ".4~g",
      automargin: true,
      fixedrange: true,
    },
    shapes: contactShape(result, units, palette),
  });
  return { data, layout, label: say("chart.sheet") };
}

function begin({ profiles }, units) {
  return { x: units.list(profiles.x, "length"), data: [] };
}

function along(units) {
  return titled(ALONG, units.name("length")) + ENDS;
}

/** What is shown along the nip, in the unit shown. */
function reach({ contact, nip_width: nip }, units) {
  const places = [contact[0][0] - SIDE * nip, contact[contact.length - 1][1] + SIDE * nip];
  return units.list(places, "length");
}

/** Limits that show pressure and shear whole; the bound may leave them. */
function span(pressure, shear) {
  const high = Math.max(...pressure, ...shear);
  const low = Math.min(0, ...shear);
  return [Math.min(1.15 * low, -0.05 * high), 1.1 * high];
}

function upTo(x, values, [from, to]) {
  const seen = values.filter((value, i) => value !== null && x[i] >= from && x[i] <= to);
  return [0, 1.06 * Math.max(...seen, 1e-9)];
}

/** Stick and slip as shaded bands; without friction the contact. */
function zonesOf(result, units, palette) {
  if (result.zones.length === 0) return contactShape(result, units, palette);
  const named = new Set();
  return result.zones.map((zone) => {
    const name = zoneName(zone);
    const first = !named.has(name);
    named.add(name);
    return band(
      units.shown(zone.from, "length"),
      units.shown(zone.to, "length"),
      palette[zone.state],
      name,
      first,
    );
  });
}

function zoneName({ state, direction }) {
  if (state === "stick") return say("zone.stick-band");
  return direction === -1 ? say("zone.upper") : say("zone.lower");
}

function zoneWords({ zones }) {
  if (zones.length === 0) return say("zone.none");
  const slips = zones.filter(({ state }) => state === "slip").length;
  if (slips === 0) return say("zone.stick");
  return slips === zones.length
    ? say("zone.slip")
    : say(slips > 1 ? "zone.slips" : "zone.one-slip", { slips });
}

function contactShape({ contact }, units, palette) {
  return contact.map(([from, to], i) =>
    band(units.shown(from, "length"), units.shown(to, "length"), palette.stick, say("zone.contact"), i === 0),
  );
}

function band(x0, x1, fillcolor, name, showlegend) {
  return {
    type: "rect",
    xref: "x",
    yref: "paper",
    x0,
    x1,
    y0: 0,
    y1: 1,
    fillcolor,
    line: { width: 0 },
    layer: "below",
    name,
    showlegend,
  };
}

/** One profile of several designs: [{tree, result}]; a design without a result keeps its letter. */
export function overlay(designs, { key, title, dimension }, units, palette) {
  const dashes = ["solid", "dash", "dot", "dashdot"];
  const unit = units.name(dimension);
  const data = designs.flatMap(({ tree, result }, i) => {
    if (!result) return [];
    const x = units.list(result.profiles.x, "length");
    const y = units.list(result.profiles[key] ?? [], dimension);
    return line(letter(i, nameOf(tree)), x, y, palette.designs[i], {
      dash: dashes[i],
      width: 2.4,
      hovertemplate: `%{y:.4~g} ${unit}`,
    });
  });
  const ranges = designs.filter(({ result }) => result).map(({ result }) => reach(result, units));
  const range = [Math.min(...ranges.map(([low]) => low)), Math.max(...ranges.map(([, high]) => high))];
  const layout = layoutOf(palette, along(units), titled(title, unit), {
    along: units.name("length"),
    xaxis: { range },
    showlegend: true,
  });
  return { data, layout, label: say("compare.label", { title, count: designs.length }) };
}

/** "A: name". */
export function letter(i, name) {
  return `${"ABCD"[i]}: ${name}`;
}
