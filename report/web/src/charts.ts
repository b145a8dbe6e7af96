import * as Plot from "@observablehq/plot";
import { SERIES } from "./colours";
import { h } from "./dom";

const WIDTH = 520;
const HEIGHT = 270;

/** A plot with what all of them share, in a figure with its caption. */
export function chart(
  caption: string,
  options: Plot.PlotOptions,
): HTMLElement {
  const plot = Plot.plot({
    width: WIDTH,
    height: HEIGHT,
    marginLeft: 62,
    marginBottom: 38,
    marginTop: 28,
    marginRight: 18,
    grid: true,
    style: { background: "transparent", fontSize: "12px", overflow: "visible" },
    ariaLabel: caption,
    ...options,
    color: { range: SERIES, ...options.color },
    symbol: { ...options.symbol },
  });
  return h("figure", { class: "chart" }, plot, h("figcaption", {}, caption));
}

/** Tick texts with few digits. */
export function tick(value: number): string {
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e5 || size < 1e-3)) {
    return value.toExponential(0).replace("e+", "e");
  }
  return String(Number(value.toPrecision(6)));
}

/** Room for words at the left of a plot. */
export function roomFor(texts: string[]): number {
  return 24 + 6.6 * Math.max(0, ...texts.map((text) => text.length));
}

export function row(...charts: (HTMLElement | null)[]): HTMLElement {
  return h("div", { class: "charts" }, ...charts);
}
