import type { MemberResult, PageData } from "./data";
import { h, section, table } from "./dom";
import { number, quantity, seconds, shownUnit, words } from "./format";
import { inputsOf, responsesOf } from "./measures";
import { rangeText } from "./rows";

/** A family's members in one table. */
export function familySection(data: PageData): HTMLElement | null {
  const members = data.result?.members;
  if (!members) {
    return null;
  }
  const numeric = true;
  const keysOf = (pick: (m: MemberResult) => object) => [
    ...new Set(members.flatMap((m) => Object.keys(pick(m) ?? {}))),
  ];
  const parameters = keysOf((m) => m.parameters);
  const design = keysOf((m) => m.design);
  const responses = keysOf((m) => m.responses);
  const inputs = inputsOf(data);
  const outputs = responsesOf(data);
  return section(
    "members",
    "Members",
    table(
      "Each member with its parameters, answer and responses",
      [
        { head: "member" },
        { head: "status" },
        ...[...parameters, ...design].map((n) => ({ head: inputs.label(n), numeric })),
        ...responses.map((n) => ({ head: outputs.label(n), numeric })),
        { head: "evaluations", numeric },
        { head: "time", numeric },
      ],
      members.map((m) => {
        const link = data.parts.find((p) => p.name === m.name)?.link;
        const sized = m.status === "converged";
        return [
          link ? h("a", { href: link }, m.name) : m.name,
          sized ? "\u2713 done" : h("strong", { class: "bad", title: m.message }, `\u2717 ${m.status}`),
          ...parameters.map((n) => rangeText(m.parameters?.[n], inputs.factor(n))),
          ...design.map((n) => rangeText(m.design?.[n], inputs.factor(n))),
          ...responses.map((n) => number(outputs.shown(n, m.responses?.[n]))),
          String(m.evaluations ?? 0),
          seconds(m.seconds),
        ];
      }),
    ),
    h("ul", {}, ...members.filter((m) => m.status !== "converged").map((m) => h("li", {}, `${m.name}: ${m.message || m.status}`))),
  );
}

/** Parts side by side, with ratios to the first. */
export function comparisonSection(data: PageData): HTMLElement | null {
  const comparison = data.comparison;
  if (!comparison) {
    return null;
  }
  const { parts, units } = comparison;
  const rows: (string | Node)[][] = [];
  const add = (what: string, unit: string, values: (number | null | undefined)[]) => {
    const line: (string | Node)[] = [what];
    values.forEach((value, k) => {
      line.push(quantity(value, unit));
      if (k > 0) {
        const first = values[0];
        line.push(value && first ? `\u00d7 ${number(value / first, 3)}` : "\u2013");
      }
    });
    rows.push(line);
  };
  add("pieces", "", parts.map((p) => p.parts));
  add("mass", units.mass, parts.map((p) => p.mass));
  add("volume", `${units.length}\u00b3`, parts.map((p) => p.volume));
  if (parts.some((p) => p.exclusion)) {
    add("volume left out of stresses", "%", parts.map((p) => 100 * (p.exclusion?.volume_share ?? 0)));
  }
  const stiffness = `${units.force}/${units.length}`;
  const [massFactor, massUnit] = shownUnit(units.mass);
  for (const name of [...new Set(parts.flatMap((p) => Object.keys(p.load_cases)))]) {
    const of = parts.map((p) => p.load_cases[name]);
    const prefix = `${words(name)}: `;
    add(`${prefix}stiffness`, stiffness, of.map((f) => f?.stiffness));
    add(`${prefix}stiffness per mass`, `${stiffness}/${massUnit}`, of.map((f) => (f?.stiffness_per_mass ?? NaN) / massFactor));
    add(`${prefix}peak von Mises stress`, units.pressure, of.map((f) => f?.max_von_mises));
    add(`${prefix}scatter of stress (coefficient of variation)`, "", of.map((f) => f?.coefficient_of_variation));
    add(`${prefix}unevenness of stress (Gini)`, "", of.map((f) => f?.gini));
  }
  const columns = [{ head: "" }, ...parts.flatMap((p, k) => [{ head: p.name, numeric: true }, ...(k > 0 ? [{ head: "to the first", numeric: true }] : [])])];
  return section("comparison", "Side by side", table("Figures of the parts", columns, rows));
}
