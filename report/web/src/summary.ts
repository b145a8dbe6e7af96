import type { BindingBound, PageData, Result, StressFigures } from "./data";
import { h, section, table } from "./dom";
import { count, direction, number, percent, quantity, seconds, words } from "./format";
import { inputsOf, responsesOf } from "./measures";
import { type DesignRow, designRows, finite, flat } from "./rows";

const STATUS: Record<string, string> = {
  converged: "done",
  infeasible: "no acceptable design",
  stopped: "stopped at a limit",
  failed: "failed",
  error: "broken off",
  interrupted: "interrupted",
};

const MOST_BINDING = 12;
const SIDES = { lower: "at least ", upper: "at most ", both: "wanted " };

export function headline(data: PageData): HTMLElement {
  const result = data.result;
  const title = result?.case || data.case?.path || data.folder;
  document.title = `${title} \u2013 Meniscus report`;
  const status = result?.status ?? "converged";
  const good = status === "converged";
  // What a good end adds to its first sentence stands below it.
  const message = result?.message ?? "";
  const end = good ? message.search(/\. (?=[A-Z'])/) : -1;
  const first = end < 0 ? message : message.slice(0, end + 1);
  const rest = end < 0 ? "" : message.slice(end + 2);
  return h(
    "header",
    {},
    h("p", { class: "kicker" }, `Meniscus \u00b7 ${kindText(data)}`),
    h("h1", {}, title),
    result
      ? h(
          "p",
          { class: `status ${good ? "good" : "bad"}`, role: good ? null : "alert" },
          h("strong", {}, STATUS[status] ?? status),
          ` ${first}`,
          rest ? h("small", {}, rest) : null,
        )
      : null,
  );
}

function kindText(data: PageData): string {
  if (data.kind === "comparison") {
    return "parts side by side";
  }
  if (data.kind === "film") {
    return "a film alone";
  }
  const kinds: Record<string, string> = {
    analyse: "analysis",
    match: "deflection matching",
    minimize: "minimisation",
    sweep: "sweep",
    tolerance: "scatter of the design",
    pareto: "compromises of two responses",
  };
  const kind = kinds[data.case?.study.kind ?? ""] ?? "run";
  return data.kind === "family" ? `family, ${kind}` : kind;
}

function card(value: string, what: string): HTMLElement {
  return h("div", { class: "card" }, h("dd", {}, value), h("dt", {}, what));
}

/** Name and figures of the load case nearest to yield, and how many there are. */
function worstLoadCase(result: Result): [string, StressFigures, number] | null {
  const cases = Object.entries(result.stress ?? {});
  if (cases.length === 0) {
    return null;
  }
  // Results of older versions do not say which.
  const safety = (f: StressFigures) => f.safety_factor?.smallest ?? Infinity;
  const worse = (a: StressFigures, b: StressFigures) =>
    safety(a) !== safety(b) ? safety(a) < safety(b) : (a.max_von_mises ?? 0) > (b.max_von_mises ?? 0);
  const found =
    cases.find(([name]) => name === result.worst_load_case) ??
    cases.reduce((most, one) => (worse(one[1], most[1]) ? one : most));
  const acting = cases.filter(([, f]) => !f.unit_load).length;
  return [found[0], found[1], acting > 1 ? acting : 0];
}

/** What the study makes least, then the others in the file's order: four. */
function firstResponses(data: PageData): string[] {
  const names = (data.case?.responses ?? []).map((r) => r.name);
  const objective = data.case?.study.objective;
  return [...names.filter((n) => n === objective), ...names.filter((n) => n !== objective)].slice(0, 4);
}

/** The few figures that one wants first. */
export function keyFigures(data: PageData): HTMLElement | null {
  const result = data.result;
  if (!result || data.kind !== "run") {
    return null;
  }
  const cards: HTMLElement[] = [];
  for (const name of firstResponses(data)) {
    const value = result.responses?.[name];
    if (value !== undefined) {
      cards.push(card(responsesOf(data).text(name, value), words(name)));
    }
  }
  const worst = worstLoadCase(result);
  if (worst) {
    const [name, figures, several] = worst;
    const where = several ? `, \u201c${words(name)}\u201d (the worst of ${several} load cases)` : "";
    cards.push(card(quantity(figures.max_von_mises, result.units?.pressure ?? ""), `largest von Mises stress${where}`));
    if (figures.safety_factor?.smallest) {
      cards.push(card(number(figures.safety_factor.smallest, 3), `safety against yield${where}`));
    }
  }
  if (result.evaluations && result.seconds?.total !== undefined) {
    cards.push(card(seconds(result.seconds.total), `${count(result.evaluations)} evaluations`));
  }
  return cards.length > 0 ? h("dl", { class: "cards" }, ...cards) : null;
}

/** " (worst load along 0.6, 0, 0.8)" of a load from any direction. */
function worstDirection(result: Result, name: string): string {
  const worst = result.worst_directions?.[name];
  return worst ? ` (worst load along ${direction(worst.direction)})` : "";
}

/** Parameters and responses with their errors. */
export function answerSection(data: PageData): HTMLElement | null {
  const result = data.result;
  if (!result || data.kind !== "run") {
    return null;
  }
  const numeric = true;
  const designs = designRows(data);
  const names = designs.map((d) => d.name);
  const parameters = result.parameters ?? {};
  const atBound = (value: number | null | undefined, d: { lower: number | null; upper: number | null }) => {
    const [low, high] = [d.lower ?? -Infinity, d.upper ?? Infinity];
    if (result.evaluations === 1 || typeof value !== "number" || !(high > low)) {
      return "";
    }
    const near = Number.isFinite(high - low) ? 1e-6 * (high - low) : 0;
    return value <= low + near ? "lower" : value >= high - near ? "upper" : "";
  };
  const boundsText = (d: DesignRow) =>
    ["lower", "upper"]
      .map((side) => [side, d.values(parameters).filter((value, k) => atBound(value, d.elements[k]) === side).length] as const)
      .filter(([, count]) => count > 0)
      .map(([side, count]) => (d.isVector ? ` (${count} at their ${side} bound)` : ` (at its ${side} bound)`))
      .join("");
  const inputs = inputsOf(data);
  const outputs = responsesOf(data);
  const rows = designs.map((d) => {
    const errors = finite(d.values(result.parameter_errors));
    const lower = finite(d.elements.map((e) => e.lower));
    const upper = finite(d.elements.map((e) => e.upper));
    const initial = Object.fromEntries(d.elements.map((e) => [e.name, e.initial]));
    return [
      d.label,
      d.text(parameters) + boundsText(d),
      inputs.error(d.name, errors.length > 0 ? Math.max(...errors) : null),
      d.text(result.start?.parameters ?? initial),
      inputs.range(d.name, lower.length > 0 ? Math.min(...lower) : null, upper.length > 0 ? Math.max(...upper) : null),
    ];
  });
  const others = Object.entries(parameters).filter(([name]) => !names.includes(name));
  const responses = Object.entries(result.responses ?? {});
  return section(
    "answer",
    responses.length > 0 ? "The answer" : "The design",
    rows.length > 0
      ? table(
          "Design variables",
          [{ head: "design variable" }, { head: responses.length > 0 ? "answer" : "value", numeric }, { head: "mesh error", numeric }, { head: "at the start", numeric }, { head: "bounds", numeric }],
          rows,
        )
      : null,
    responses.length > 0
      ? table(
          "Responses",
          [{ head: "response" }, { head: "answer", numeric }, { head: "mesh error", numeric }, { head: "at the start", numeric }],
          responses.map(([name, value]) => [
            words(name) + worstDirection(result, name),
            outputs.text(name, value),
            outputs.error(name, result.response_errors?.[name]),
            outputs.text(name, result.start?.responses[name]),
          ]),
        )
      : null,
    constraintTable(data, result),
    bindingTable(data, result),
    others.length > 0
      ? table(
          "Parameters of the case",
          [{ head: "parameter" }, { head: "value", numeric }],
          others.map(([name, value]) => [words(name), inputs.text(name, flat(value)[0])]),
        )
      : null,
  );
}

/** "at most 0.1 mm". */
function boundText(data: PageData, name: string, bound: number | null): string {
  const text = (value: number | null) => responsesOf(data).text(name, value);
  const sides = (data.case?.study.constraints ?? [])
    .filter((b) => b.response === name)
    .flatMap((b) =>
      b.min !== null && b.min === b.max
        ? [`wanted ${text(b.min)}`]
        : [b.min !== null ? `at least ${text(b.min)}` : "", b.max !== null ? `at most ${text(b.max)}` : ""],
    )
    .filter((side) => side !== "");
  return sides.length > 0 ? sides.join(", ") : text(bound);
}

function constraintTable(data: PageData, result: Result): HTMLElement | null {
  const constraints = Object.entries(result.constraints ?? {});
  if (constraints.length === 0) {
    return null;
  }
  const matches = data.case?.study.kind === "match";
  const peaks = result.norm_peaks ?? {};
  const worstOf = Object.fromEntries(
    Object.entries(result.envelopes ?? {}).map(([name, e]) => [name, e.most ?? e.least ?? ""]),
  );
  const peakOf = (name: string) => peaks[name] ?? peaks[worstOf[name] ?? ""];
  const beside = constraints.some(([name]) => peakOf(name));
  const unit = result.units?.pressure ?? "";
  return table(
    matches ? "Targets: relative mismatch" : "Constraints",
    [
      { head: matches ? "target" : "constraint" },
      { head: "value", numeric: true },
      { head: matches ? "tolerance" : "bound", numeric: true },
      { head: "kept" },
      ...(beside ? [{ head: "nodal peak", numeric: true }] : []),
    ],
    constraints.map(([name, c]) => {
      const peak = peakOf(name);
      const ratio = peak?.of === "bound";
      const text = !peak ? "" : ratio ? number(peak.peak) : quantity(peak.peak, unit);
      const over = peak?.peak_within_bound === false;
      return [
        peak && !ratio
          ? `${words(name)} (a mean over the volume)`
          : worstOf[name]
            ? `${words(name)} (${words(worstOf[name])})`
            : words(name),
        matches ? number(c.value) : responsesOf(data).text(name, c.value),
        matches ? number(c.bound) : boundText(data, name, c.bound),
        c.satisfied ? "\u2713 yes" : h("strong", { class: "bad" }, "\u2717 no"),
        ...(beside ? [over ? h("strong", { class: "bad" }, `${text} \u2717 above the bound`) : text] : []),
      ];
    }),
  );
}

/** What the bounds that hold a minimum are worth; those of a vector on one side are one row. */
function bindingTable(data: PageData, result: Result): HTMLElement | null {
  const vectors = designRows(data).filter((row) => row.isVector);
  const groups = new Map<string, { label: string; bounds: BindingBound[] }>();
  for (const bound of result.multipliers?.binding ?? []) {
    const vector =
      bound.of === "variable" ? vectors.find((row) => row.elements.some((e) => e.name === bound.name)) : undefined;
    const label = vector?.label ?? words(bound.name);
    const key = [bound.of, label, bound.side].join(" ");
    groups.set(key, { label, bounds: [...(groups.get(key)?.bounds ?? []), bound] });
  }
  const objective = data.case?.study.objective ?? "";
  const rows = [...groups.values()].slice(0, MOST_BINDING).map(({ label, bounds }) => {
    const [first] = bounds;
    const measures = first.of === "constraint" ? responsesOf(data) : inputsOf(data);
    const change = bounds.reduce((sum, bound) => sum + (bound.change ?? 0), 0);
    const part = result.objective ? ` (${percent(change / Math.abs(result.objective), 2)})` : "";
    return [
      label,
      bounds.length > 1
        ? `${count(bounds.length)} at ${first.side} bounds`
        : SIDES[first.side] + measures.text(first.name, first.bound),
      bounds.length > 1 ? `each by ${percent(0.01)}` : measures.text(first.name, first.bound + first.step),
      responsesOf(data).text(objective, change) + part,
    ];
  });
  const more = groups.size - rows.length;
  return rows.length === 0
    ? null
    : table(
        `What binds, and what it is worth${more > 0 ? ` (${count(more)} more of less weight)` : ""}`,
        [
          { head: "of" },
          { head: "bound", numeric: true },
          { head: "moved to", numeric: true },
          { head: `change of ${words(objective)}`, numeric: true },
        ],
        rows,
      );
}

const EVENTS: Record<string, string> = {
  film_rejoins: "films join in another way",
  film_pinched: "a neck closes",
};

/** Where the model was frozen anew, and where films come to other lines or none. */
function eventTexts(result: Result): string[] {
  return [
    ...(result.refrozen ?? []).map((r) => `frozen anew at evaluation ${count(r.evaluation)}: ${r.reason}`),
    ...(result.topology ?? []).map(
      (event) =>
        `${EVENTS[event.kind] ?? words(event.kind)} at ${count(event.designs)} design${event.designs === 1 ? "" : "s"}, ` +
        `nearest to the start at evaluation ${count(event.evaluation)}: ${event.message}`,
    ),
  ];
}

/** How far to trust it. */
export function checksSection(data: PageData): HTMLElement | null {
  const result = data.result;
  if (!result) {
    return null;
  }
  const rows: (string | Node)[][] = [];
  const mark = (good: boolean) => (good ? "\u2713" : "\u2717");
  if (result.film) {
    const f = result.film;
    rows.push(
      [mark(f.verdict === "stable"), "film at rest and stable", `${f.verdict}; smallest eigenvalue ${number(f.min_eigenvalue, 3)}`],
      [mark(f.residual <= f.residual_bound), "film's forces in balance", `residual ${quantity(f.residual, result.units?.force ?? "")} (bound ${number(f.residual_bound, 2)})`],
    );
  }
  if (result.tet && result.tet.elements > 0) {
    const good = result.tet.min_dihedral_deg > 5 && result.tet.max_dihedral_deg < 175;
    rows.push([mark(good), "shape of the elements", `${count(result.tet.elements)} elements, angles ${number(result.tet.min_dihedral_deg, 3)}\u00b0 to ${number(result.tet.max_dihedral_deg, 4)}\u00b0`]);
  }
  if (result.fea && result.fea.dofs > 0) {
    rows.push([mark(result.fea.reaction_imbalance < 1e-6), "reactions balance the loads", `off by ${number(result.fea.reaction_imbalance, 2)} of them; ${count(result.fea.dofs)} unknowns`]);
  }
  if (result.element_errors) {
    rows.push([mark(result.element_errors.energy < 0.15), "elements' own error in energy", percent(result.element_errors.energy, 2)]);
  }
  const warnings = result.warnings ?? [];
  const events = eventTexts(result);
  if (rows.length === 0 && warnings.length === 0 && events.length === 0) {
    return null;
  }
  return section(
    "checks",
    "Checks and warnings",
    rows.length > 0 ? table("Checks of the answer", [{ head: "" }, { head: "check" }, { head: "found" }], rows) : null,
    warnings.length > 0
      ? h("ul", { class: "warnings" }, ...warnings.map((w) => h("li", {}, w)))
      : h("p", {}, "No warnings."),
    events.length > 0 ? h("h3", {}, "On the way") : null,
    events.length > 0 ? h("ul", { class: "events" }, ...events.map((text) => h("li", {}, text))) : null,
  );
}
