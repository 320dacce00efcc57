// Values are kept in mm, N, MPa, s for good; units are only a way of showing them.

import { LARGE, RESULT_UNITS } from "./figures.js";

export const DIGITS = 4;
const ASKED = { "angle of axes": "angle", share: "ratio", "roller force": "force", "air pressure": "pressure" };
const METRIC_LARGE = { "roller force": { from: 1e5, unit: "kN", scale: 1e3 } }; // of a press
const WRITTEN = {
  degC: "°C",
  degF: "°F",
  "N m": "N·m",
  "N m/m": "N·m/m",
  "lbf in/in": "lbf·in/in",
  "W/(m2 K)": "W/(m² K)",
  "BTU/(h ft2 degF)": "BTU/(h ft² °F)",
  "BTU/(h ft degF)": "BTU/(h ft °F)",
  "BTU/(lb degF)": "BTU/(lb °F)",
  "1/degF": "1/°F",
};

/** Shows values of the base system in metric or US units. */
export class Units {
  constructor(table, system) {
    this.table = table;
    this.system = system;
  }

  /** {name, scale, offset} of a dimension for values up to `largest`; name "" where it has no unit. */
  of(dimension, largest = 0) {
    const large = LARGE[dimension] ?? (this.system === "metric" ? METRIC_LARGE[dimension] : undefined);
    if (large && Math.abs(largest) >= large.from) return { name: large.unit, scale: large.scale, offset: 0 };
    if (RESULT_UNITS[dimension]) {
      const [name, scale] = RESULT_UNITS[dimension][this.system];
      return { name, scale, offset: 0 };
    }
    const kind = this.table[dimension];
    const name = kind?.[this.system] ?? "";
    const [scale, offset] = kind?.units?.[name] ?? [1, 0];
    return { name, scale: Number(scale), offset: Number(offset) };
  }

  /** Whether the server reads texts of a dimension; what only results have it does not. */
  isRead(dimension) {
    return dimension === "share" || dimension in this.table;
  }

  /** The unit as a person writes it. */
  name(dimension) {
    const { name } = this.of(dimension);
    return written(name);
  }

  shown(value, dimension) {
    const { scale, offset } = this.of(dimension);
    return (value - offset) / scale;
  }

  base(shown, dimension) {
    const { scale, offset } = this.of(dimension);
    return shown * scale + offset;
  }

  /** {text, unit} of a value of the base system, in the unit for its size. */
  format(value, dimension, digits = DIGITS) {
    if (value === null || value === undefined) return { text: "–", unit: "" };
    const { name, scale, offset } = this.of(dimension, value);
    return { text: number((value - offset) / scale, digits), unit: written(name) };
  }

  /** A value of a figure of the registry, in the unit for its size. */
  figure({ dimension, digits }, value) {
    return this.text(value, dimension, digits);
  }

  /** The same as one text. */
  text(value, dimension, digits = DIGITS) {
    const { text, unit } = this.format(value, dimension, digits);
    return joined(text, unit);
  }

  /** An estimated error, in the unit of its figure: one digit more than none. */
  error(value, dimension) {
    const { scale } = this.of(dimension);
    return joined(number(value / scale, 2), this.name(dimension));
  }

  /** Values of a curve. */
  list(values, dimension) {
    return values.map((value) => (value === null ? null : this.shown(value, dimension)));
  }
}

/** The dimension that the server reads and writes one of the page as. */
export function askedAs(dimension) {
  return ASKED[dimension] ?? dimension;
}

/** A unit as a person writes it. */
export function written(name) {
  return WRITTEN[name] ?? name;
}

/** "4 mm", "4 %", "4": a number and its unit. */
export function joined(text, unit) {
  return unit ? `${text}\u202f${unit}` : text;
}

/** The largest of 1, 2, 5, 10, ... that is not above a number. */
export function nice(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return power * Math.max(...[1, 2, 5].filter((digit) => digit * power <= value * (1 + 1e-9)));
}

/** A number to some significant digits, without trailing noise. */
export function number(value, digits = DIGITS) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-5) return power(value, digits);
  const text = String(Number(value.toPrecision(digits)));
  return text.replace("-", "\u2212");
}

/** The same as a text that a box can read back. */
export function typable(value, digits = DIGITS) {
  return number(value, digits).replace(/·10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)/, (_power, raised) => {
    const exponent = [...raised].map((sign) => "-0123456789"["⁻⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(sign)]);
    return `e${exponent.join("")}`;
  });
}

function power(value, digits) {
  const [mantissa, exponent] = value.toExponential(Math.max(0, digits - 2)).split("e");
  const raised = [...String(Number(exponent))]
    .map((sign) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(sign)])
    .join("");
  return `${Number(mantissa)}·10${raised}`.replace("-", "\u2212");
}
