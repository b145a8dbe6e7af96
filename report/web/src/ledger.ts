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
function ledgerTables(ledger: Record<string, unknown>): HTMLElement[] {
  const tables: HTMLElement[] = [];
  const single: Entries = [];
  for (const [name, value] of Object.entries(ledger)) {
    if (Array.isArray(value)) {
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
    children.push(...ledgerTables(ledger as Record<string, unknown>));
  }
  return children.length > 0
    ? section("cost", "What it cost", h("div", { class: "columns" }, ...children))
    : null;
}
