/** Numbers for people: few digits, a unit, no more noise than needed. */

const MINUS = "\u2212";

/** Four significant digits unless told otherwise. */
export function number(
  value: number | null | undefined,
  digits = 4,
): string {
  if (value === null || value === undefined || !Number.isFinite(value)) {
    return "\u2013";
  }
  if (value === 0) {
    return "0";
  }
  const size = Math.abs(value);
  let text: string;
  if (size >= 1e6 || size < 1e-4) {
    const [mantissa, exponent] = size.toExponential(digits - 1).split("e");
    text = `${trim(mantissa)}\u00d710${superscript(Number(exponent))}`;
  } else {
    const whole = Math.floor(Math.log10(size)) + 1;
    text =
      whole >= digits
        ? group(String(Math.round(size)))
        : trim(size.toPrecision(digits));
  }
  return value < 0 ? MINUS + text : text;
}

/** Factor and unit in which people read masses: kg, where a case counts in tonnes. */
export function shownUnit(unit: string): [number, string] {
  const shown: Record<string, [number, string]> = {
    t: [1000, "kg"],
    "lbf s2/in": [386.0885826771654, "lb"],
  };
  return shown[unit] ?? [1, unit];
}

/** "0.1040 mm". */
export function quantity(
  value: number | null | undefined,
  caseUnit = "",
  digits = 4,
): string {
  const [factor, unit] = shownUnit(caseUnit);
  const text = number(typeof value === "number" ? factor * value : value, digits);
  return unit === "" || text === "\u2013" ? text : `${text}\u202f${unit}`;
}

/** "\u00b1 0.0031 mm" or nothing. */
export function plusMinus(
  error: number | null | undefined,
  unit = "",
): string {
  return error === null || error === undefined || !Number.isFinite(error)
    ? ""
    : `\u00b1 ${quantity(Math.abs(error), unit, 2)}`;
}

export function percent(part: number, digits = 3): string {
  return `${number(100 * part, digits)}\u202f%`;
}

export function count(value: number | null | undefined): string {
  return value === null || value === undefined
    ? "\u2013"
    : group(String(Math.round(value)));
}

export function seconds(value: number | null | undefined): string {
  if (value === null || value === undefined) {
    return "\u2013";
  }
  return value < 120
    ? quantity(value, "s", 3)
    : `${Math.floor(value / 60)} min ${Math.round(value % 60)} s`;
}

export function bytes(value: number): string {
  const units = ["B", "kB", "MB", "GB"];
  let k = 0;
  while (value >= 1000 && k + 1 < units.length) {
    value /= 1000;
    ++k;
  }
  return quantity(value, units[k], 3);
}

/** "left_deflection" as words. */
export function words(name: string): string {
  return name.replace(/_/g, " ");
}

/** "mm3" with its exponent raised. */
export function unitText(unit: string): string {
  return unit.replace(/([a-z])([23])\b/g, (_all, letter: string, n: string) =>
    letter + superscript(Number(n)),
  );
}

function trim(text: string): string {
  return text.includes(".") ? text.replace(/\.?0+$/, "") : text;
}

function group(digits: string): string {
  return digits.length > 4
    ? digits.replace(/\B(?=(\d{3})+$)/g, "\u202f")
    : digits;
}

function superscript(value: number): string {
  const raised = "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079";
  return String(value).replace(/[-\d]/g, (c) =>
    c === "-" ? "\u207b" : raised[Number(c)],
  );
}

/** "0.6, 0, \u22120.8" of a unit vector. */
export function direction(d: (number | null)[]): string {
  const nothing = 5e-4; // below what three digits show
  return d.map((x) => number(x !== null && Math.abs(x) < nothing ? 0 : x, 3)).join(", ");
}
