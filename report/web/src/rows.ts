import type { DesignVariable, Inputs, Nested, PageData } from "./data";
import { number, words } from "./format";
import { inputsOf, type Measures } from "./measures";

/** The numbers of nested arrays, the last index running fastest. */
export function flat(nested: Nested | undefined): (number | null)[] {
  return Array.isArray(nested) ? nested.flatMap(flat) : [nested ?? null];
}

/** Design variables as people name them: one, or all elements of a vector. */
export class DesignRow {
  constructor(
    readonly name: string,
    readonly shape: number[], // none: one variable
    /** Of its first variable among all. */
    readonly first: number,
    readonly elements: DesignVariable[],
    private readonly measures: Measures,
  ) {}

  get isVector(): boolean {
    return this.shape.length > 0;
  }

  /** "support x", "t [8 \u00d7 12]". */
  get label(): string {
    return words(this.name) + (this.isVector ? ` [${this.shape.join(" \u00d7 ")}]` : "");
  }

  /** Of each element, from a table of all inputs by name. */
  values(inputs: Inputs | null | undefined): (number | null)[] {
    const own = inputs?.[this.name];
    return this.isVector && own === undefined
      ? this.elements.map((e) => flat(inputs?.[e.name])[0])
      : flat(own);
  }

  /** The same as they are shown. */
  shown(inputs: Inputs | null | undefined): (number | null)[] {
    return this.values(inputs).map((value) => this.measures.shown(this.name, value));
  }

  /** "25 mm", "0.71 to 1.42 mm, mean 1.03 mm", "1 mm each". */
  text(inputs: Inputs | null | undefined): string {
    const values = this.values(inputs);
    const found = finite(values);
    const [low, high] = [Math.min(...found), Math.max(...found)];
    const text = (value: number | null) => this.measures.text(this.name, value);
    if (!this.isVector || found.length === 0) {
      return text(values[0]);
    }
    return low === high ? `${text(low)} each` : `${this.measures.range(this.name, low, high)}, mean ${text(mean(found))}`;
  }
}

export function finite(values: (number | null)[]): number[] {
  return values.filter((v): v is number => typeof v === "number" && Number.isFinite(v));
}

export function mean(values: number[]): number {
  return values.reduce((sum, v) => sum + v, 0) / values.length;
}

/** "20", "20 to 31" of nested numbers, times a factor. */
export function rangeText(nested: Nested | undefined, factor = 1): string {
  const found = finite(flat(nested)).map((v) => factor * v);
  const [low, high] = [Math.min(...found), Math.max(...found)];
  return found.length === 0 ? number(null) : low === high ? number(low) : `${number(low)} to ${number(high)}`;
}

export function designRows(data: PageData): DesignRow[] {
  const all = data.case?.design ?? [];
  const measures = inputsOf(data);
  const rows: DesignRow[] = [];
  for (let k = 0; k < all.length; k += rows[rows.length - 1].elements.length) {
    const vector = data.case?.vectors?.find((v) => v.first === k);
    const count = vector?.shape.reduce((product, along) => product * along, 1) ?? 1;
    rows.push(
      new DesignRow(vector?.name ?? all[k].name, vector?.shape ?? [], k, all.slice(k, k + count), measures),
    );
  }
  return rows;
}
