import * as Plot from "@observablehq/plot";

/** Maps that keep their order for colour-blind eyes and in print. */
export const MAPS = ["viridis", "cividis", "greys"] as const;
export type MapName = (typeof MAPS)[number];

const SIZE = 256;

/** RGBA bytes, dark to bright. */
export function mapBytes(name: MapName): Uint8Array {
  const scale = Plot.scale({ color: { scheme: name, domain: [0, 1] } })!;
  const result = new Uint8Array(4 * SIZE);
  for (let i = 0; i < SIZE; ++i) {
    const t = i / (SIZE - 1);
    // Greys run from white; the others from dark.
    const colour = String(scale.apply(name === "greys" ? 1 - 0.85 * t : t));
    const rgb = colour.startsWith("#")
      ? [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16))
      : (colour.match(/\d+(\.\d+)?/g) ?? []).map(Number);
    result.set([rgb[0], rgb[1], rgb[2], 255], 4 * i);
  }
  return result;
}

/** The same as a CSS gradient, left to right. */
export function mapGradient(name: MapName): string {
  const bytes = mapBytes(name);
  const stops: string[] = [];
  for (let i = 0; i < SIZE; i += 15) {
    stops.push(`rgb(${bytes[4 * i]},${bytes[4 * i + 1]},${bytes[4 * i + 2]})`);
  }
  return `linear-gradient(to right, ${stops.join(",")})`;
}

/** Okabe and Ito (2008): told apart by colour-blind readers. */
export const SERIES = [
  "#0072b2",
  "#d55e00",
  "#009e73",
  "#cc79a7",
  "#e69f00",
  "#56b4e9",
];
