import type { PageData } from "./data";
import { number, plusMinus, quantity, shownUnit, unitText, words } from "./format";

/** Numbers of responses, or of what goes in, as people read them: by name, times a factor, in a unit. */
export class Measures {
  constructor(private readonly caseUnit: (name: string) => string | undefined) {}

  factor(name: string): number {
    return shownUnit(this.caseUnit(name) ?? "")[0];
  }

  unit(name: string): string {
    return unitText(shownUnit(this.caseUnit(name) ?? "")[1]);
  }

  /** The number as it is shown; null for none. */
  shown(name: string, value: number | null | undefined): number | null {
    return typeof value === "number" ? this.factor(name) * value : null;
  }

  /** "left deflection [mm]". */
  label(name: string): string {
    return this.unit(name) ? `${words(name)} [${this.unit(name)}]` : words(name);
  }

  /** "0.1040 mm". */
  text(name: string, value: number | null | undefined): string {
    return quantity(this.shown(name, value), this.unit(name));
  }

  /** "\u00b1 0.0031 mm" or nothing. */
  error(name: string, error: number | null | undefined): string {
    return plusMinus(this.shown(name, error), this.unit(name));
  }

  /** "40 to 90 mm". */
  range(name: string, low: number | null | undefined, high: number | null | undefined): string {
    return `${number(this.shown(name, low))} to ${this.text(name, high)}`;
  }
}

export function responsesOf(data: PageData): Measures {
  return new Measures((name) => data.case?.responses.find((r) => r.name === name)?.unit);
}

/** Design variables and parameters. */
export function inputsOf(data: PageData): Measures {
  return new Measures(
    (name) => {
      const at = data.case?.vectors?.find((v) => v.name === name)?.first;
      const variable = at === undefined ? data.case?.design.find((d) => d.name === name) : data.case?.design[at];
      return variable?.unit ?? data.case?.parameter_units?.[name];
    },
  );
}
