import * as Plot from "@observablehq/plot";
import { chart, roomFor, row, tick } from "./charts";
import type { PageData } from "./data";
import { h, section, table } from "./dom";
import { number, words } from "./format";
import { historyOf } from "./history";
import { inputsOf, responsesOf } from "./measures";
import { designRows, finite, flat, mean, rangeText } from "./rows";

/** A sweep: every response over every design variable. */
export function sweepSection(data: PageData): HTMLElement | null {
  const sweep = data.result?.sweep;
  if (!sweep) {
    return null;
  }
  const responses = responsesOf(data);
  const inputs = inputsOf(data);
  const rows = historyOf(data).filter((r) => r.status === "ok");
  const charts: HTMLElement[] = [];
  for (const response of Object.keys(sweep.responses)) {
    for (const design of designRows(data)) {
      const found = rows.flatMap((r) => {
        const values = finite(design.shown(r.values));
        const x = values.length > 0 ? mean(values) : null;
        const y = responses.shown(response, r.values[response]);
        return typeof x === "number" && typeof y === "number" ? [{ x, y }] : [];
      });
      charts.push(
        chart(`${responses.label(response)} over ${design.isVector ? "the mean of " : ""}${design.label}, ${found.length} designs.`, {
          x: { label: `${inputs.label(design.name)} \u2192`, tickFormat: tick },
          y: { label: `\u2191 ${responses.label(response)}`, tickFormat: tick },
          marks: [Plot.dot(found, { x: "x", y: "y", stroke: "#0072b2", r: 3.2 })],
        }),
      );
    }
  }
  const numeric = true;
  return section(
    "sweep",
    "The sweep",
    h("p", {}, `${sweep.looked_at} of ${sweep.designs} designs looked at, ${sweep.failed} could not be evaluated.`),
    table(
      "Responses over all designs",
      [{ head: "response" }, { head: "least", numeric }, { head: "mean", numeric }, { head: "largest", numeric }],
      Object.entries(sweep.responses).map(([name, s]) => [
        words(name),
        ...[s.least, s.mean, s.largest].map((value) => responses.text(name, value)),
      ]),
    ),
    row(...charts.slice(0, 24)),
  );
}

/** Compromises of two responses. */
export function frontSection(data: PageData): HTMLElement | null {
  const front = data.result?.front;
  if (!front) {
    return null;
  }
  const responses = responsesOf(data);
  const inputs = inputsOf(data);
  const [first, second] = front.objectives;
  const found = front.points.flatMap((p) => {
    const x = responses.shown(first, p[first] as number | null);
    const y = responses.shown(second, p[second] as number | null);
    return typeof x === "number" && typeof y === "number" ? [{ x, y, parameters: p.parameters }] : [];
  });
  const [a, b] = [first, second].map((name) => responses.label(name));
  const names = designRows(data).map((d) => d.name);
  const numeric = true;
  return section(
    "front",
    "Compromises",
    row(
      chart(`Designs that no other beats in both ${words(first)} and ${words(second)}.`, {
        x: { label: `${a} \u2192`, tickFormat: tick },
        y: { label: `\u2191 ${b}`, tickFormat: tick },
        marks: [
          Plot.line(found, { x: "x", y: "y", stroke: "#0072b2", strokeOpacity: 0.5 }),
          Plot.dot(found, { x: "x", y: "y", fill: "#0072b2", r: 4 }),
        ],
      }),
    ),
    table(
      "Points of the front",
      [{ head: a, numeric }, { head: b, numeric }, ...names.map((n) => ({ head: inputs.label(n), numeric }))],
      found.map((p) => [number(p.x), number(p.y), ...names.map((n) => rangeText(p.parameters[n], inputs.factor(n)))]),
    ),
  );
}

/** How far the responses spread when the design scatters. */
export function toleranceSection(data: PageData): HTMLElement | null {
  const tolerance = data.result?.tolerance;
  if (!tolerance) {
    return null;
  }
  const responses = responsesOf(data);
  const inputs = inputsOf(data);
  const shares = Object.entries(tolerance.responses).flatMap(([response, r]) =>
    Object.entries(r.shares ?? {}).map(([variable, share]) => ({
      response: words(response),
      variable: words(variable),
      share: 100 * finite(flat(share)).reduce((sum, s) => sum + s, 0), // of a vector all of it
    })),
  );
  const numeric = true;
  return section(
    "tolerance",
    "Scatter",
    table(
      "Standard deviations of the design variables",
      [{ head: "design variable" }, { head: "deviation", numeric }],
      Object.entries(tolerance.deviations).map(([name, d]) => {
        const all = finite(flat(d));
        return [
          words(name),
          all.length > 1 ? inputs.range(name, Math.min(...all), Math.max(...all)) : inputs.text(name, flat(d)[0]),
        ];
      }),
    ),
    table(
      "Standard deviations of the responses",
      [{ head: "response" }, { head: "by the gradient", numeric }, { head: "sampled", numeric }, { head: "sampled mean", numeric }, { head: "least to largest sampled", numeric }],
      Object.entries(tolerance.responses).map(([name, r]) => {
        const s = r.sampled;
        return [
          words(name),
          responses.text(name, r.deviation),
          s ? `${responses.text(name, s.deviation)} ${responses.error(name, s.deviation_error)}` : "\u2013",
          s ? `${responses.text(name, s.mean)} ${responses.error(name, s.mean_error)}` : "\u2013",
          s ? responses.range(name, s.least, s.largest) : "\u2013",
        ];
      }),
    ),
    shares.length > 0
      ? row(
          chart("Which design variable the scatter of each response comes from.", {
            marginLeft: roomFor(shares.map((s) => s.response)),
            x: { label: "share of the variance [%] \u2192" },
            y: { label: null },
            color: { legend: true },
            marks: [Plot.barX(shares, { x: "share", y: "response", fill: "variable" })],
          }),
        )
      : null,
  );
}

/** What a step of each design variable does to each response. */
export function sensitivitySection(data: PageData): HTMLElement | null {
  const gradients = data.gradients;
  const design = designRows(data);
  if (!gradients || design.length === 0) {
    return null;
  }
  const rows: (string | Node)[][] = [];
  const bars: { response: string; variable: string; change: number }[] = [];
  data.case!.responses.forEach((response, r) => {
    const line = gradients.rows[r] ?? [];
    if (line.every((g) => g === null)) {
      return;
    }
    const value = data.result?.responses?.[response.name];
    // All elements of a vector move together.
    const slopes = design.map((d) => line.slice(d.first, d.first + d.elements.length));
    design.forEach((d, k) => {
      const all = finite(slopes[k]);
      if (all.length === d.elements.length && value) {
        const change = d.elements.reduce((sum, e, i) => sum + all[i] * ((e.upper ?? 1) - (e.lower ?? 0)), 0);
        bars.push({ response: words(response.name), variable: d.label, change: change / Math.abs(value) });
      }
    });
    rows.push([
      words(response.name),
      // Per unit as it is shown.
      ...design.map((d, k) => {
        const all = finite(slopes[k]);
        const slope = all.reduce((sum, g) => sum + g, 0) / inputsOf(data).factor(d.name);
        return responsesOf(data).text(response.name, all.length === d.elements.length ? slope : null);
      }),
    ]);
  });
  if (rows.length === 0) {
    return null;
  }
  bars.sort((a, b) => Math.abs(b.change) - Math.abs(a.change));
  const text = gradients.at_answer
    ? "Exact derivatives at the answer."
    : `Exact derivatives at evaluation ${gradients.evaluation}, the nearest to the answer that has them.`;
  const arrows = data.curves?.some((c) => Object.keys(c.motion).length > 0)
    ? " \u201cPush the curves this way\u201d in the 3-D view draws them on the boundary curves: arrows show how to move the curves to cut or raise a response, longer where it helps more."
    : "";
  return section(
    "sensitivities",
    "What moves the responses",
    h("p", {}, text + arrows),
    row(
      bars.length > 0
        ? chart("Change of a response, in percent of its value, per 1 % of a design variable's range.", {
            marginLeft: roomFor(bars.map((b) => `${b.response}, by ${b.variable}`)),
            height: Math.min(700, 90 + 20 * bars.slice(0, 30).length),
            x: { label: "change [%] \u2192", tickFormat: tick },
            y: { label: null, domain: bars.slice(0, 30).map((b) => `${b.response}, by ${b.variable}`) },
            marks: [
              Plot.barX(bars.slice(0, 30), { x: "change", y: (b) => `${b.response}, by ${b.variable}`, fill: (b) => (b.change > 0 ? "raises" : "lowers"), inset: 1 }),
              Plot.ruleX([0]),
            ],
            color: { domain: ["raises", "lowers"], legend: true },
          })
        : null,
    ),
    table(
      "Change of each response per unit of each design variable",
      [{ head: "response" }, ...design.map((d) => ({
          head: `per ${inputsOf(data).unit(d.name) || "unit"} of ${d.isVector ? "all of " : ""}${d.label}`,
          numeric: true,
        }))],
      rows,
    ),
  );
}

