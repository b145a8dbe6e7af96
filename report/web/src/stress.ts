import * as Plot from "@observablehq/plot";
import { chart, row, tick } from "./charts";
import type { Distribution, PageData } from "./data";
import { h, section, table } from "./dom";
import { direction, number, quantity, words } from "./format";

function histogram(d: Distribution, what: string, unit: string): HTMLElement {
  const step = d.peak / d.histogram.length;
  const bars = d.histogram.map((share, k) => ({
    from: k * step,
    to: (k + 1) * step,
    share: 100 * share,
  }));
  const marks = [
    { at: d.mean, text: "mean" },
    { at: d.p95, text: "95 %" },
  ];
  return chart(
    `Share of the volume by ${what} [${unit}]: mean ${quantity(d.mean, unit, 3)}; 95 % of the volume is below ${quantity(d.p95, unit, 3)}; peak ${quantity(d.peak, unit, 3)}.`,
    {
      x: { label: `${what} [${unit}] \u2192`, tickFormat: tick },
      y: { label: "\u2191 share of the volume [%]" },
      marks: [
        Plot.rectY(bars, { x1: "from", x2: "to", y: "share", fill: "#0072b2", insetLeft: 0.5 }),
        Plot.ruleX(marks, { x: "at", strokeDasharray: "4 3" }),
        Plot.text(marks, { x: "at", text: "text", frameAnchor: "top", dy: -8 }),
        Plot.ruleY([0]),
      ],
    },
  );
}

/** How evenly the part is stressed, per load case. */
export function stressSection(data: PageData): HTMLElement | null {
  const cases = Object.entries(data.result?.stress ?? {}).filter(([, f]) => !f.unit_load);
  const units = data.result!.units!;
  const children: HTMLElement[] = [];
  if (cases.length > 1) {
    const worst = data.result?.worst_load_case;
    children.push(
      table(
        "Load cases",
        [{ head: "load case" }, { head: "largest von Mises stress", numeric: true }, { head: "safety against yield", numeric: true }, { head: "" }],
        cases.map(([name, f]) => [
          words(name) + (f.direction ? ` (worst along ${direction(f.direction)})` : ""),
          quantity(f.max_von_mises, units.pressure),
          number(f.safety_factor?.smallest, 3),
          name === worst ? h("strong", {}, "the worst") : "",
        ]),
      ),
    );
  }
  for (const [name, figures] of cases) {
    const von = figures.von_mises;
    const energy = figures.energy_density;
    const safety = figures.safety_factor;
    if (!von) {
      continue;
    }
    if (cases.length > 1) {
      children.push(h("h3", {}, `Load case \u201c${words(name)}\u201d`));
    }
    const rows: (string | Node)[][] = [
      ["largest von Mises stress at a node", quantity(figures.max_von_mises, units.pressure)],
      ["mean over the volume", quantity(von.mean, units.pressure)],
      ["scatter around the mean (coefficient of variation)", number(von.coefficient_of_variation, 3)],
      ["unevenness (Gini: 0 even, 1 all in one spot)", number(von.gini, 3)],
      ["half of the volume is below", quantity(von.p50, units.pressure)],
      ["95 % of the volume is below", quantity(von.p95, units.pressure)],
      ["peak over mean", number(von.peak_over_mean, 3)],
    ];
    if (safety && safety.smallest !== null) {
      rows.push([`safety against yield of ${words(safety.material)}`, number(safety.smallest, 3)]);
    }
    children.push(
      row(
        histogram(von, "von Mises stress", units.pressure),
        energy ? histogram(energy, "strain energy density", `${units.force}\u00b7${units.length}/${units.length}\u00b3`) : null,
      ),
      table(`Stress under \u201c${words(name)}\u201d`, [{ head: "figure" }, { head: "value", numeric: true }], rows),
    );
  }
  if (children.length === 0) {
    return null;
  }
  children.push(
    h(
      "p",
      { class: "hint" },
      "A stress where the part is clamped grows with every refinement: trust deflections and the 95 % figure before the last peak there.",
    ),
  );
  return section("stress", "Stress and how even it is", ...children);
}

/** Factors that matter with their errors, or what none that matters is below. */
function bucklingText(b: NonNullable<NonNullable<PageData["result"]>["buckling"]>[string]): string {
  if (!b.factors || b.factors.length === 0) {
    return b.none_below == null ? "not found" : `none below ${number(b.none_below)}`;
  }
  if (b.verdict === "beyond_yield") {
    return `none that matters below ${number(b.above)}`;
  }
  return b.factors
    .filter((_, k) => b.stress?.[k]?.matters ?? true)
    .map((f, k) => {
      const error = b.errors?.[k];
      return error == null ? `${number(f)} (error not known)` : `${number(f)} \u00b1 ${number(error)}`;
    })
    .join(", ");
}

/** Buckling factors and natural frequencies, where there are any. */
export function eigenSection(data: PageData): HTMLElement | null {
  const buckling = Object.entries(data.result?.buckling ?? {});
  const frequencies = data.result?.natural_frequencies;
  const children: HTMLElement[] = [];
  if (buckling.length > 0) {
    children.push(
      table(
        "Buckling: all loads of the case times this factor",
        [{ head: "load case" }, { head: "smallest factors", numeric: true }],
        buckling.map(([name, b]) => [
          words(name),
          bucklingText(b),
        ]),
      ),
    );
  }
  if (frequencies) {
    children.push(
      table(
        `Natural frequencies${frequencies.supports_of ? `, ${frequencies.supports_of === "free" ? "free part" : `held as in \u201c${frequencies.supports_of}\u201d`}` : ""}`,
        [{ head: "mode", numeric: true }, { head: "frequency", numeric: true }],
        frequencies.values.map((f, k) => [String(k + 1), quantity(f, "1/s")]),
      ),
    );
  }
  return children.length > 0 ? section("modes", "Buckling and vibration", ...children) : null;
}

