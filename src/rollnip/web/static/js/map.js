// An answer over two inputs: a map of full solutions.

import { post } from "./api.js";
import { layoutOf, line, titled } from "./charts.js";
import { setAt } from "./paths.js";
import { say } from "./texts.js";

export const SIDE = 9; // values of each input

/** Solve row by row; `told(rows)` hears of every row, null where one is still to come. */
export async function solveMap({ tree, input, second, xs, ys }, signal, told) {
  const rows = ys.map(() => null);
  const order = ys.map((_y, i) => i).sort((a, b) => (a % 3) - (b % 3));
  for (const i of order) {
    const varied = setAt(tree, second.path, ys[i]);
    const answer = await post("/api/sweep", { case: varied, path: input.path, values: xs }, signal);
    rows[i] = answer.results;
    told([...rows]);
  }
}

/** The map as a chart: contours over both inputs, a dot for the design. */
export function mapChart({ input, second, asked, xs, ys, rows, now }, units, palette) {
  const shown = (one, list) => list.map((value) => units.shown(value * one.factor, one.dimension));
  const unit = units.name(asked.dimension);
  const sound = (one) => one && !one.error && one.converged !== false && one[asked.key] !== null;
  const z = rows.map((row) =>
    xs.map((_x, j) => (row && sound(row[j]) ? units.shown(row[j][asked.key], asked.dimension) : null)),
  );
  const [x, y] = [shown(input, xs), shown(second, ys)];
  const [own, other] = [units.name(input.dimension), units.name(second.dimension)];
  const map = {
    type: "contour",
    name: asked.label,
    x,
    y,
    z,
    ncontours: 14,
    colorscale: palette.sequential,
    contours: { coloring: "fill", showlabels: true, labelfont: { size: 11 } },
    line: { width: 0.6, color: `${palette.ink}88` },
    colorbar: { title: { text: titled(asked.label, unit), side: "right" }, thickness: 13, outlinewidth: 0 },
    hovertemplate: `%{x:.4~g} ${own}, %{y:.4~g} ${other}: %{z:.4~g} ${unit}<extra></extra>`,
  };
  const dot = line(say("map.design"), shown(input, [now.value]), shown(second, [now.second]), palette.shear, {
    mode: "markers",
    marker: { size: 13, color: palette.shear, line: { color: palette.ground, width: 2 } },
    showlegend: false,
    hoverinfo: "name",
  });
  const layout = layoutOf(palette, titled(input.label, own), titled(second.label, other), {
    hovermode: "closest",
  });
  const label = say("map.label", { answer: asked.label, x: input.label, y: second.label });
  return { data: [map, dot], layout, label };
}
