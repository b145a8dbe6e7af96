import type { PageData } from "./data";
import { number, plusMinus, quantity, shownUnit, unitText, words } from "./format";

/** A response, design variable or parameter as people read it: its number times `factor`, in `unit`. */
export interface Measure {
  factor: number;
  unit: string;
}

export function measureOf(data: PageData, name: string): Measure {
  const input = data.case;
  const [factor, unit] = shownUnit(
    input?.responses.find((r) => r.name === name)?.unit ??
      input?.design.find((d) => d.name === name)?.unit ??
      input?.parameter_units?.[name] ??
      "",
  );
  return { factor, unit: unitText(unit) };
}

/** The number as it is shown; null for none. */
export function shown(data: PageData, name: string, value: number | null | undefined): number | null {
  return typeof value === "number" ? measureOf(data, name).factor * value : null;
}

/** "left deflection [mm]". */
export function labelOf(data: PageData, name: string): string {
  const { unit } = measureOf(data, name);
  return unit ? `${words(name)} [${unit}]` : words(name);
}

/** "0.1040 mm". */
export function textOf(data: PageData, name: string, value: number | null | undefined, digits = 4): string {
  return quantity(shown(data, name, value), measureOf(data, name).unit, digits);
}

/** "\u00b1 0.0031 mm" or nothing. */
export function errorOf(data: PageData, name: string, error: number | null | undefined): string {
  return plusMinus(shown(data, name, error), measureOf(data, name).unit);
}

/** "40 to 90 mm". */
export function rangeOf(data: PageData, name: string, low: number | null | undefined, high: number | null | undefined): string {
  return `${number(shown(data, name, low))} to ${textOf(data, name, high)}`;
}
