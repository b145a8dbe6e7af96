import type { PageData } from "./data";
import { h, section, table } from "./dom";
import { bytes, count, number, quantity, seconds, words } from "./format";

function cell(key: string, value: unknown): string {
  if (typeof value !== "number") {
    return value === null || value === undefined ? "\u2013" : String(value);
  }
  if (/bytes/.test(key)) {
    return bytes(value);
  }
  if (/seconds/.test(key)) {
    return quantity(value, "s", 3);
  }
  return Number.isInteger(value) ? count(value) : number(value);
}

interface Amount {
  elements: number;
  area: number | null;
  bytes: number;
}

interface Stage {
  name: string;
  before: Amount;
  after: Amount;
  operations: number | null;
  seconds: number | null;
}

interface FileSize {
  name: string;
  bytes: number;
  written: boolean;
}

function change(before: string, after: string): string {
  return before === after ? after : `${before} \u2192 ${after}`;
}

function stagesTable(stages: Stage[], length: string): HTMLElement {
  const numeric = true;
  const area = (a: Amount) => (a.area === null || a.area === undefined ? "\u2013" : number(a.area));
  return table(
    "One evaluation of the answer, and what was done once before it",
    [
      { head: "stage" },
      { head: "curves, facets or elements", numeric },
      { head: `area [${length}\u00b2]`, numeric },
      { head: "size", numeric },
      { head: "operations", numeric },
      { head: "time", numeric },
    ],
    stages.map((s) => [
      s.name,
      change(count(s.before.elements), count(s.after.elements)),
      change(area(s.before), area(s.after)),
      change(bytes(s.before.bytes), bytes(s.after.bytes)),
      number(s.operations, 3),
      s.seconds === null ? "\u2013" : quantity(s.seconds, "s", 3),
    ]),
  );
}

function filesTable(files: FileSize[], input: number): HTMLElement {
  const numeric = true;
  return table(
    `The same part as files, beside the case file of ${bytes(input)}`,
    [{ head: "file" }, { head: "size", numeric }, { head: "times the case file", numeric }, { head: "" }],
    files.map((f) => [
      f.name,
      bytes(f.bytes),
      input > 0 ? `\u00d7 ${number(f.bytes / input, 3)}` : "\u2013",
      f.written ? "" : "if exported",
    ]),
  );
}

type Entries = [string, unknown][];

function isTable(value: unknown): value is Record<string, object> {
  return (
    typeof value === "object" &&
    value !== null &&
    Object.values(value).length > 0 &&
    Object.values(value).every((v) => typeof v === "object" && v !== null)
  );
}

/** A table of whatever rows there are; columns are all keys met. */
function rowsTable(caption: string, rows: Entries): HTMLElement {
  const columns: string[] = [];
  for (const [, row] of rows) {
    for (const [key, value] of Object.entries(row as object)) {
      if (!columns.includes(key) && (typeof value !== "object" || value === null)) {
        columns.push(key);
      }
    }
  }
  return table(
    caption,
    [{ head: "" }, ...columns.map((c) => ({ head: words(c), numeric: true }))],
    rows.map(([name, row]) => [words(name), ...columns.map((c) => cell(c, (row as Record<string, unknown>)[c]))]),
  );
}

function named(list: unknown[]): Entries {
  return list.map((row, k) => {
    const entries = row as Record<string, unknown>;
    const key = ["stage", "name", "what", "file"].find((n) => typeof entries[n] === "string");
    const { [key ?? ""]: _name, ...rest } = entries;
    return [key ? String(entries[key]) : String(k + 1), rest];
  });
}

/** Every group of the ledger as a table, single figures together. */
function ledgerTables(ledger: Record<string, unknown>, length: string): HTMLElement[] {
  const tables: HTMLElement[] = [];
  const single: Entries = [];
  for (const [name, value] of Object.entries(ledger)) {
    if (name === "stages" && Array.isArray(value) && value.every((s) => s.before && s.after)) {
      tables.push(stagesTable(value as Stage[], length));
    } else if (name === "files" && Array.isArray(value)) {
      tables.push(filesTable(value as FileSize[], Number(ledger.input_bytes ?? 0)));
    } else if (name === "input_bytes") {
      continue; // stands above the files
    } else if (Array.isArray(value)) {
      tables.push(rowsTable(words(name), named(value)));
    } else if (isTable(value)) {
      tables.push(rowsTable(words(name), Object.entries(value)));
    } else if (typeof value === "object" && value !== null) {
      tables.push(
        table(
          words(name),
          [{ head: "" }, { head: "value", numeric: true }],
          Object.entries(value).map(([key, v]) => [words(key), cell(`${name} ${key}`, v)]),
        ),
      );
    } else {
      single.push([name, value]);
    }
  }
  if (single.length > 0) {
    tables.push(table("Figures", [{ head: "" }, { head: "value", numeric: true }], single.map(([key, v]) => [words(key), cell(key, v)])));
  }
  return tables;
}

/** What the answer cost. */
export function ledgerSection(data: PageData): HTMLElement | null {
  const result = data.result;
  if (!result) {
    return null;
  }
  const stages: [string, string][] = [
    ["evolve", "settling films"],
    ["mesh", "elements"],
    ["fea", "elasticity"],
    ["gradient", "gradients"],
    ["output", "files and pictures"],
    ["total", "in all"],
  ];
  const spent = stages.filter(([key]) => result.seconds?.[key] !== undefined);
  const children: HTMLElement[] = [];
  if (spent.length > 0) {
    children.push(
      table(
        "Time",
        [{ head: "stage" }, { head: "time", numeric: true }],
        spent.map(([key, text]) => [text, seconds(result.seconds![key])]),
      ),
    );
  }
  const ledger = result.ledger;
  if (Array.isArray(ledger)) {
    children.push(rowsTable("Stages", named(ledger)));
  } else if (typeof ledger === "object" && ledger !== null) {
    children.push(...ledgerTables(ledger as Record<string, unknown>, result.units?.length ?? ""));
  }
  return children.length > 0
    ? section("cost", "What it cost", h("div", { class: "columns" }, ...children))
    : null;
}
