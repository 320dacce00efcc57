// The charts of heat: temperature over depth, warm-up, steady states over speed or load.

import { layoutOf, line, titled } from "./charts.js";
import { curveName, figureIn } from "./quantities.js";
import { say } from "./texts.js";

const SIDES = ["upper", "lower"];
const DEGREES = "temperature";

/** Temperature below the surface of both rollers, hot spots and bonds marked. */
export function depthChart(heat, tree, units, palette) {
  const unit = units.name(DEGREES);
  const hover = { hovertemplate: `%{y:.4~g} ${unit}` };
  const curves = SIDES.map((side) => depthsOf(heat[side], side, tree));
  const deepest = Math.max(1e-3, ...curves.map(({ depth }) => Math.max(...depth)));
  const data = SIDES.flatMap((side, i) => {
    const { depth, temperature, isOne } = curves[i];
    const x = units.list(isOne ? [0, deepest] : depth, "length");
    const y = units.list(isOne ? [temperature[0], temperature[0]] : temperature, DEGREES);
    const style = isOne ? { dash: "dash", ...hover } : { width: 2.6, ...hover };
    const lines = [line(say(isOne ? `heat.whole-${side}` : `roller.${side}`), x, y, palette[side], style)];
    const { hot_spot: hot, hot_spot_depth: at } = heat[side];
    if (!isOne) lines.push(mark(named(side, "hot_spot"), [units.shown(at, "length")], [units.shown(hot, DEGREES)], palette[side], "circle"));
    return lines;
  });
  const bonds = SIDES.flatMap((side, i) => (curves[i].isOne ? [] : facesOf(tree[side])).map((depth) => bond(units.shown(depth, "length"), palette[side])));
  const layout = layoutOf(palette, titled(say("axis.depth"), units.name("length")), titled(figureIn("course", "temperature").label, unit), {
    along: units.name("length"),
    xaxis: { rangemode: "tozero" },
    shapes: bonds,
  });
  const spots = Object.fromEntries(SIDES.map((side) => [side, units.figure(figureIn("heat", "hot_spot"), heat[side].hot_spot)]));
  return { data, layout, label: say("heat.chart-depth", spots) };
}

/** A figure of one roller in a legend. */
function named(side, key) {
  return `${say(`roller.${side}`)}: ${curveName("heat", key)}`;
}

/** Depths from the surface to the inside, and the temperatures there. */
function depthsOf({ r, temperature }) {
  const top = r[r.length - 1];
  if (r.length === 1) return { depth: [0], temperature, isOne: true };
  return { depth: r.map((radius) => top - radius).reverse(), temperature: [...temperature].reverse(), isOne: false };
}

/** Depths of the interfaces of a roller, its bond last. */
function facesOf({ layers }) {
  let depth = 0;
  return layers.map(({ thickness }) => (depth += thickness));
}

function bond(x, colour) {
  return { type: "line", xref: "x", yref: "paper", x0: x, x1: x, y0: 0, y1: 1, line: { color: colour, width: 1, dash: "dot" } };
}

function mark(name, x, y, colour, symbol) {
  const marker = { color: colour, size: 9, symbol };
  return { type: "scatter", mode: "markers", name, x, y, marker, cliponaxis: false, hoverinfo: "skip" };
}

/** Hot spot and surface of both rollers over time. */
export function warmChart(course, units, palette) {
  const unit = units.name(DEGREES);
  const time = figureIn("course", "time");
  const { name: along, scale } = units.of(time.dimension, course.time[course.time.length - 1]);
  const x = course.time.map((at) => at / scale);
  const hover = { hovertemplate: `%{y:.4~g} ${unit}` };
  const data = SIDES.flatMap((side) => [
    line(named(side, "hot_spot"), x, units.list(course[side].hot_spot, DEGREES), palette[side], { width: 2.6, ...hover }),
    line(named(side, "surface_temperature"), x, units.list(course[side].surface, DEGREES), palette[side], { dash: "dash", ...hover }),
  ]);
  const layout = layoutOf(palette, titled(time.label, along), titled(figureIn("course", "temperature").label, unit), { along });
  return { data, layout, label: say("heat.chart-warm") };
}

/** Hot spot over speed or load: stable states, others, runaway, and the design. */
export function branchChart(branch, heat, units, palette) {
  const { dimension, label: name } = figureIn("course", branch.parameter);
  const [unit, along] = [units.name(DEGREES), units.name(dimension)];
  const shown = (points) => [
    units.list(points.map(({ value }) => value), dimension),
    units.list(points.map(({ hot_spot: hot }) => hot), DEGREES),
  ];
  const hover = { hovertemplate: `%{x:.4~g} ${along}, %{y:.4~g} ${unit}` };
  const known = new Set();
  const data = runsOf(branch.points).map(({ stable, points }) => {
    const [x, y] = shown(points);
    const kind = stable ? "stable" : "unstable";
    const style = stable ? { width: 2.6 } : { dash: "dash" };
    const one = line(say(`heat.${kind}`), x, y, palette[stable ? "pressure" : "muted"], { ...style, ...hover, showlegend: !known.has(kind) });
    known.add(kind);
    return one;
  });
  if (branch.turning) data.push(mark(say("heat.runaway"), ...shown([branch.turning]), palette.alert, "circle"));
  if (heat.converged) {
    const hot = Math.max(...SIDES.map((side) => heat[side].hot_spot));
    data.push(mark(say("heat.here"), ...shown([{ value: branch.value, hot_spot: hot }]), palette.shear, "diamond"));
  }
  const layout = layoutOf(palette, titled(name, along), titled(figureIn("heat", "hot_spot").label, unit), { along, hovermode: "closest" });
  return { data, layout, label: say("heat.chart-branch") };
}

/** The pieces of a branch between whose points all states are stable, or not all. */
function runsOf(points) {
  const runs = [];
  points.slice(1).forEach((point, i) => {
    const stable = points[i].stable && point.stable;
    const last = runs[runs.length - 1];
    if (last && last.stable === stable) last.points.push(point);
    else runs.push({ stable, points: [points[i], point] });
  });
  return runs;
}

/** Temperatures over depth as rows of a table, units in the head. */
export function depthRows(heat, tree, units) {
  const head = [
    say("csv.roller"),
    `${say("axis.depth")} [${units.of("length").name}]`,
    `${figureIn("course", "temperature").label} [${units.of(DEGREES).name}]`,
  ];
  const rows = SIDES.flatMap((side) => {
    const { depth, temperature } = depthsOf(heat[side], side, tree);
    const [x, y] = [units.list(depth, "length"), units.list(temperature, DEGREES)];
    return x.map((value, i) => [say(`roller.${side}`), value, y[i]]);
  });
  return [head, ...rows];
}
