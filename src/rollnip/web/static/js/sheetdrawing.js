// The sheet in the drawings: between the surfaces, thick enough to be seen.

import { svg } from "./dom.js";
import { say } from "./texts.js";
import { nice, number } from "./units.js";

const THIN = 6; // px: a thinner sheet is drawn thicker, up to this
const LINE = 2.4; // px of the sheet in the drawing of the pair
const INSIDE = 0.06; // of the nip width: where its slope at an edge is taken

/** How a sheet is drawn where a millimetre is `scale` pixels: {pixels, times}, `times` as thick as it is. */
export function sheetSize({ thickness }, scale) {
  const times = Math.max(1, nice(THIN / (thickness * scale)));
  return { times, pixels: times * thickness * scale };
}

/** What a caption says of the sheet: how much thicker it is drawn, and what its way outside is. */
export function sheetCaption({ times }) {
  return times > 1 ? say("drawing.sheet", { times: number(times) }) : say("drawing.sheet-true");
}

/** The sheet of the section: along both surfaces in the nip, straight outside. */
export function sheetInNip({ contact, nip_width: nip }, { upper, lower }, frame, pixels, palette) {
  const [from, to] = [contact[0][0], contact[contact.length - 1][1]];
  const points = lower.x
    .map((x, i) => [x, 0.5 * (upper.z[i] + lower.z[i])])
    .filter(([x]) => x >= from && x <= to);
  const straight = (ends, at) => {
    const near = ends.find(([x]) => Math.abs(x - ends[0][0]) >= INSIDE * nip) ?? ends[ends.length - 1];
    const [[x0, z0], [x1, z1]] = [ends[0], near];
    return [at, z0 + ((z1 - z0) / (x1 - x0)) * (at - x0)];
  };
  const [first, last] = frame.reach;
  const whole = [straight(points, first), ...points, straight([...points].reverse(), last)];
  const edge = (sign) => whole.map(([x, z]) => `${frame.x(x).toFixed(2)} ${(frame.y(z) + 0.5 * sign * pixels).toFixed(2)}`);
  const d = `M${edge(-1).join("L")}L${edge(1).reverse().join("L")}Z`;
  return svg("path", { d, class: "sheet", fill: palette.sheet, stroke: palette.ink, "stroke-width": 0.7 });
}

/** The sheet between both rollers whole, as a line. */
export function sheetInPair(y, width, palette) {
  return svg("path", { d: `M0 ${y}H${width}`, class: "sheet", stroke: palette.sheetLine, "stroke-width": LINE });
}
