import type { PageData } from "./data";

export interface HistoryRow {
  evaluation: number;
  status: string;
  phase: string;
  message: string;
  values: Record<string, number | null>;
}

/** Cells of comma-separated lines, quotes doubled inside quotes. */
export function parseCsv(text: string): string[][] {
  const rows: string[][] = [];
  let row: string[] = [];
  let cell = "";
  let quoted = false;
  for (let i = 0; i < text.length; ++i) {
    const c = text[i];
    if (quoted) {
      if (c === '"' && text[i + 1] === '"') {
        cell += '"';
        ++i;
      } else if (c === '"') {
        quoted = false;
      } else {
        cell += c;
      }
    } else if (c === '"') {
      quoted = true;
    } else if (c === ",") {
      row.push(cell);
      cell = "";
    } else if (c === "\n") {
      row.push(cell.replace(/\r$/, ""));
      rows.push(row);
      row = [];
      cell = "";
    } else {
      cell += c;
    }
  }
  if (cell !== "" || row.length > 0) {
    row.push(cell);
    rows.push(row);
  }
  return rows;
}

/** The evaluations of history.csv. */
export function historyOf(data: PageData): HistoryRow[] {
  const [head, ...lines] = parseCsv(data.history ?? "");
  return lines.map((line) => {
    const row: HistoryRow = {
      evaluation: 0,
      status: "",
      phase: "",
      message: "",
      values: {},
    };
    head.forEach((name, k) => {
      const text = line[k] ?? "";
      if (name === "status" || name === "phase" || name === "message") {
        row[name] = text;
      } else if (name === "evaluation") {
        row.evaluation = Number(text);
      } else {
        row.values[name] = text === "" ? null : Number(text);
      }
    });
    return row;
  });
}
