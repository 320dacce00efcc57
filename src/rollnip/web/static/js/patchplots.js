// The pictures and figures of a patch: pressure with isolines, stick and slip with the shear.

import { layoutOf, line, titled } from "./charts.js";
import { curveName, figureIn } from "./quantities.js";
import { say } from "./texts.js";

const ARROWS = 13; // lines of shear along the longer side of the patch
const FIGURES = ["load", "approach", "length", "width", "area", "peak_pressure"];
const OF_FRICTION = [
  "traction_x",
  "traction_y",
  "spin_moment",
  "creepage",
  "lateral_creepage",
  "friction_resistance",
  "dissipation_friction",
];
const OF_LOSSES = ["rolling_resistance", "viscous_resistance", "dissipation_viscous", "load_centre"];

/** The figures of a result as {key, label, value, error, dimension}; `friction` of the nip. */
export function patchRows({ patch }, friction) {
  const isLossy = (key) => Boolean(patch[key]);
  const wanted = [...FIGURES, ...(friction > 0 ? OF_FRICTION : []), ...OF_LOSSES.filter(isLossy)];
  return wanted
    .filter((key) => patch[key] !== null && patch[key] !== undefined)
    .map((key) => {
      const { label, dimension } = figureIn("patch", key);
      const error = patch.error[key] ?? null;
      const isNoise = error !== null && Math.abs(patch[key]) <= error;
      const signed = OF_FRICTION.includes(key);
      return { key, label, value: isNoise && signed ? 0 : patch[key], error, dimension };
    });
}

/** Share of the patch that slips; null without friction. */
export function slipShare({ fields }) {
  const states = fields.state.flat();
  const inside = states.filter((state) => state > 0);
  return inside.length ? inside.filter((state) => state === 2).length / inside.length : 0;
}

/** The pressure over the patch, with isolines. */
export function pressureMap({ patch, fields }, units, palette) {
  const unit = units.name("pressure");
  const length = units.name("length");
  const map = {
    type: "contour",
    name: curveName("field", "pressure"),
    ...places(fields, units),
    z: fields.pressure.map((row) => units.list(row, "pressure")),
    zmin: 0,
    ncontours: 11,
    colorscale: palette.sequential,
    contours: { coloring: "fill", showlines: true },
    line: { width: 0.8, color: `${palette.ink}99` },
    colorbar: { title: { text: titled(curveName("field", "pressure"), unit), side: "right" }, thickness: 12, outlinewidth: 0 },
    hovertemplate: `x %{x:.4~g}, y %{y:.4~g} ${length}: %{z:.4~g} ${unit}<extra></extra>`,
  };
  const text = (key) => units.figure(figureIn("patch", key), patch[key]);
  const label = say("patch.map-pressure", {
    peak: text("peak_pressure"),
    length: text("length"),
    width: text("width"),
  });
  return { data: [map], layout: mapLayout(units, palette), label };
}

/** The gap between the surfaces beside the patch; none where a face does not reach. */
export function gapMap({ fields }, units, palette) {
  return fieldMap("gap", curveName("field", "gap"), "length", fields.gap, { fields, units, palette });
}

/** How fast the surfaces slip over each other, as a share of the rolling speed. */
export function slipMap({ fields }, units, palette) {
  return fieldMap("slipping", say("patch.slipping"), "share", fields.slip, { fields, units, palette });
}

function fieldMap(name, title, dimension, rows, { fields, units, palette }) {
  const unit = units.name(dimension);
  const length = units.name("length");
  const map = {
    type: "heatmap",
    ...places(fields, units),
    z: rows.map((row) => units.list(row, dimension)),
    zmin: 0,
    zsmooth: false,
    colorscale: palette.sequential,
    colorbar: { title: { text: titled(title, unit), side: "right" }, thickness: 12, outlinewidth: 0 },
    hovertemplate: `x %{x:.4~g}, y %{y:.4~g} ${length}: %{z:.4~g} ${unit}<extra></extra>`,
  };
  return { data: [map], layout: mapLayout(units, palette), label: say(`patch.map-${name}`) };
}

/** Where the surfaces stick and where they slip, and the shear on the upper roller. */
export function zonesMap(result, units, palette) {
  const { fields } = result;
  const colours = [palette.ground, palette.stick, palette.slip];
  const scale = colours.flatMap((colour, i) => [
    [i / 3, colour],
    [(i + 1) / 3, colour],
  ]);
  const zones = {
    type: "heatmap",
    ...places(fields, units),
    z: fields.state,
    zmin: -0.5,
    zmax: 2.5,
    colorscale: scale,
    showscale: false,
    hoverinfo: "skip",
  };
  const key = (name, colour) =>
    line(name, [null], [null], colour, {
      mode: "markers",
      marker: { symbol: "square", size: 12, color: colour, line: { color: palette.bound, width: 1 } },
    });
  const data = [
    zones,
    key(say("patch.stick"), palette.stick),
    key(say("patch.slip"), palette.slip),
    arrows(fields, units, palette),
  ];
  const label = say("patch.map-zones", { share: Math.round(100 * slipShare(result)) });
  return { data, layout: { ...mapLayout(units, palette), showlegend: true }, label };
}

/** The shear as lines that begin at a dot. */
function arrows({ x, y, shear_x: along, shear_y: across, state }, units, palette) {
  const step = Math.max(1, Math.ceil(Math.max(x.length, y.length) / ARROWS));
  const spacing = step * Math.min(x[1] - x[0], y[1] - y[0]);
  const sizes = along.flatMap((row, i) => row.map((value, j) => Math.hypot(value, across[i][j])));
  const longest = Math.max(...sizes, 1e-30);
  const [xs, ys] = [[], []];
  const from = Math.floor(step / 2);
  for (let i = from; i < y.length; i += step)
    for (let j = from; j < x.length; j += step) {
      if (!state[i][j]) continue;
      const reach = spacing / longest;
      xs.push(x[j], x[j] + reach * along[i][j], null);
      ys.push(y[i], y[i] + reach * across[i][j], null);
    }
  const dots = xs.map((_x, i) => (i % 3 === 0 ? 4 : 0));
  return line(say("patch.shear"), units.list(xs, "length"), units.list(ys, "length"), palette.shear, {
    mode: "lines+markers",
    width: 1.6,
    marker: { size: dots, color: palette.shear, line: { width: 0 } },
    hoverinfo: "skip",
  });
}

function places({ x, y }, units) {
  return { x: units.list(x, "length"), y: units.list(y, "length") };
}

/** Both directions in one scale. */
function mapLayout(units, palette) {
  const length = units.name("length");
  return layoutOf(palette, titled(say("axis.along"), length) + say("axis.ends"), titled(say("patch.axis-across"), length), {
    xaxis: { constrain: "domain", zeroline: false, tickangle: 0, nticks: 5 },
    yaxis: { scaleanchor: "x", scaleratio: 1, constrain: "domain", zeroline: false },
    hovermode: "closest",
  });
}

/** The fields as rows of a table, units in the head. */
export function patchColumns({ fields }, units) {
  const [length, pressure] = [units.of("length").name, units.of("pressure").name];
  const head = [
    `x [${length}]`,
    `y [${length}]`,
    `${curveName("field", "pressure")} [${pressure}]`,
    `${curveName("field", "shear_x")} [${pressure}]`,
    `${curveName("field", "shear_y")} [${pressure}]`,
    say("patch.state"),
    say("patch.slip-column"),
    `${curveName("field", "gap")} [${length}]`,
  ];
  const shown = (value, dimension) => units.shown(value, dimension);
  const rows = fields.y.flatMap((y, i) =>
    fields.x.map((x, j) => [
      shown(x, "length"),
      shown(y, "length"),
      ...["pressure", "shear_x", "shear_y"].map((name) => shown(fields[name][i][j], "pressure")),
      fields.state[i][j],
      fields.slip[i][j],
      fields.gap[i][j] === null ? "" : shown(fields.gap[i][j], "length"),
    ]),
  );
  return [head, ...rows];
}
