import * as Plot from "@observablehq/plot";
import { chart, row, tick } from "./charts";
import type { PageData } from "./data";
import { h, section } from "./dom";
import { number, words } from "./format";
import { historyOf, type HistoryRow } from "./history";
import { responsesOf } from "./measures";
import { designRows, finite, mean } from "./rows";

/** Whole numbers only, at most a dozen. */
function axisX(rows: HistoryRow[]): Plot.ScaleOptions {
  const last = Math.max(1, ...rows.map((r) => r.evaluation));
  const step = Math.ceil(last / 12);
  const ticks = Array.from({ length: last }, (_v, k) => k + 1);
  return {
    label: "evaluation \u2192",
    ticks: ticks.filter((k) => k % step === 0 || step === 1),
    tickFormat: String,
  } as Plot.ScaleOptions;
}

/** The stored mismatch, or what the responses of a match come to. */
function mismatchOf(data: PageData, row: HistoryRow): number | null {
  const stored = row.values.mismatch;
  const study = data.case?.study;
  if (typeof stored === "number" || !study) {
    return stored ?? null;
  }
  const value = (name: string) => row.values[name] ?? NaN;
  const off = Object.entries(study.targets).map(
    ([name, target]) => Math.abs(value(name) - target) / Math.abs(target),
  );
  for (const name of study.equal.slice(1)) {
    const a = value(study.equal[0]);
    const b = value(name);
    off.push((2 * Math.abs(a - b)) / (Math.abs(a) + Math.abs(b)));
  }
  return off.length > 0 ? Math.max(...off) : null;
}

interface Point {
  evaluation: number;
  value: number;
  series: string;
  kind: string;
}

function points(
  rows: HistoryRow[],
  series: string,
  value: (row: HistoryRow) => number | null | undefined,
): Point[] {
  return rows.flatMap((r) => {
    const v = value(r);
    return v === null || v === undefined || !Number.isFinite(v)
      ? []
      : [{ evaluation: r.evaluation, value: v, series, kind: r.phase }];
  });
}

function lineAndDots(data: Point[], many: boolean): Plot.Markish[] {
  const steps = data.filter((p) => p.kind !== "difference");
  return [
    Plot.line(steps, { x: "evaluation", y: "value", stroke: "series", strokeWidth: 1.6 }),
    Plot.dot(data, {
      x: "evaluation",
      y: "value",
      stroke: "series",
      symbol: many ? "series" : undefined,
      fill: "var(--surface)",
      r: 3.2,
    }),
  ];
}

function mismatchChart(data: PageData, rows: HistoryRow[]): HTMLElement | null {
  const found = points(rows, "mismatch", (r) => mismatchOf(data, r)).filter((p) => p.value > 0);
  const tolerance = data.case?.study.tolerance;
  if (found.length === 0 || data.case?.study.kind !== "match") {
    return null;
  }
  return chart(
    `Largest relative mismatch per evaluation (log scale)${tolerance ? `; dashed: the tolerance ${number(tolerance, 2)}` : ""}.`,
    {
      x: axisX(rows),
      y: { type: "log", label: "\u2191 mismatch", tickFormat: tick, ticks: 6 },
      marks: [
        tolerance ? Plot.ruleY([tolerance], { strokeDasharray: "5 4" }) : null,
        ...lineAndDots(found, false),
      ],
    },
  );
}

function objectiveChart(data: PageData, rows: HistoryRow[]): HTMLElement | null {
  const name = data.case?.study.objective;
  if (!name) {
    return null;
  }
  const responses = responsesOf(data);
  const label = responses.label(name);
  const found = points(rows, words(name), (r) => responses.shown(name, r.values[name]));
  const log = found.length > 0 && found.every((p) => p.value > 0) &&
    Math.max(...found.map((p) => p.value)) > 20 * Math.min(...found.map((p) => p.value));
  return found.length < 2
    ? null
    : chart(`Objective ${label} per evaluation${log ? " (log scale)" : ""}.`, {
        x: axisX(rows),
        y: { type: log ? "log" : "linear", label: `\u2191 ${label}`, tickFormat: tick },
        marks: lineAndDots(found, false),
      });
}

function constraintChart(data: PageData, rows: HistoryRow[]): HTMLElement | null {
  const bounds = data.case?.study.constraints ?? [];
  const found: Point[] = [];
  for (const bound of bounds) {
    for (const [limit, what] of [
      [bound.max, "upper"],
      [bound.min, "lower"],
    ] as const) {
      if (limit !== null && limit !== 0) {
        const sides = bound.max !== null && bound.min !== null ? ` (${what} bound)` : "";
        found.push(
          ...points(rows, `${words(bound.response)}${sides}`, (r) => {
            const v = r.values[bound.response];
            return v === null || v === undefined ? null : v / limit;
          }),
        );
      }
    }
  }
  return found.length < 2
    ? null
    : chart("Constrained responses as parts of their bounds; at 1 (dashed) a bound is just met.", {
        x: axisX(rows),
        y: { label: "\u2191 response / bound", tickFormat: tick },
        symbol: { legend: true },
        marks: [Plot.ruleY([1], { strokeDasharray: "5 4" }), ...lineAndDots(found, true)],
      });
}

function responseCharts(data: PageData, rows: HistoryRow[]): HTMLElement[] {
  const responses = responsesOf(data);
  const byUnit = new Map<string, string[]>();
  for (const response of data.case?.responses ?? []) {
    const unit = responses.unit(response.name);
    byUnit.set(unit, [...(byUnit.get(unit) ?? []), response.name]);
  }
  const charts: HTMLElement[] = [];
  for (const [unit, names] of byUnit) {
    const found = names.flatMap((name) => points(rows, words(name), (r) => responses.shown(name, r.values[name])));
    const isObjective = names.length === 1 && names[0] === data.case?.study.objective;
    if (found.length >= 2 && !isObjective) {
      const what = unit ? `[${unit}]` : "";
      charts.push(
        chart(`Responses ${what} per evaluation.`, {
          x: axisX(rows),
          y: { label: `\u2191 ${names.length === 1 ? words(names[0]) : "response"} ${what}`, tickFormat: tick },
          symbol: { legend: names.length > 1 },
          marks: lineAndDots(found, names.length > 1),
        }),
      );
    }
  }
  return charts;
}

function designChart(data: PageData, rows: HistoryRow[]): HTMLElement | null {
  const found = designRows(data).flatMap((d) => {
    const places = (r: HistoryRow) =>
      finite(
        d.values(r.values).map((v, k) => {
          const low = d.elements[k]?.lower ?? 0;
          const range = (d.elements[k]?.upper ?? 1) - low;
          return v === null || range <= 0 ? null : (100 * (v - low)) / range;
        }),
      );
    const series = (label: string, pick: (found: number[]) => number) =>
      points(rows, label, (r) => (places(r).length > 0 ? pick(places(r)) : null));
    return d.isVector
      ? [
          ...series(`${d.label}, lowest`, (p) => Math.min(...p)),
          ...series(`${d.label}, mean`, mean),
          ...series(`${d.label}, highest`, (p) => Math.max(...p)),
        ]
      : series(d.label, (p) => p[0]);
  });
  return found.length < 2
    ? null
    : chart("Design variables between their lower (0 %) and upper (100 %) bound.", {
        x: axisX(rows),
        y: { label: "\u2191 place between the bounds [%]", domain: [0, 100] },
        symbol: { legend: true },
        marks: lineAndDots(found, true),
      });
}

/** How the study went, evaluation by evaluation. */
export function convergenceSection(data: PageData): HTMLElement | null {
  const all = historyOf(data);
  const rows = all.filter((r) => !r.phase.startsWith("coarse "));
  const failed = rows.filter((r) => r.status !== "ok");
  const kind = data.case?.study.kind;
  const searches = kind !== "sweep" && kind !== "tolerance";
  const charts = searches
    ? [
        mismatchChart(data, rows),
        objectiveChart(data, rows),
        constraintChart(data, rows),
        ...responseCharts(data, rows),
        designChart(data, rows),
      ].filter((c) => c !== null)
    : [];
  if (charts.length === 0 && failed.length === 0) {
    return null;
  }
  const trouble = failed.length
    ? h(
        "details",
        {},
        h("summary", {}, `${failed.length} of ${rows.length} designs could not be evaluated`),
        h("ul", {}, ...failed.slice(0, 50).map((r) => h("li", {}, `Evaluation ${r.evaluation}: ${r.message}`))),
      )
    : null;
  return section("convergence", "How the study went", row(...charts), trouble);
}
