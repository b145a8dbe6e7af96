import type { PageData } from "./data";
import { h, section } from "./dom";

/** The case file, with the line numbers that messages name. */
export function caseSection(data: PageData): HTMLElement | null {
  const input = data.case;
  if (!input) {
    return null;
  }
  const list = h("ol", { class: "code", tabindex: 0, "aria-label": "lines of the case file" });
  for (const line of input.text.replace(/\n$/, "").split("\n")) {
    list.append(h("li", {}, h("code", {}, line)));
  }
  return section("case", "The case file", h("p", {}, h("code", {}, input.path)), list);
}

function quoted(text: string): string {
  return /^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replace(/'/g, "'\\''")}'`;
}

/** How to come to the same answer again. */
export function reproduceSection(data: PageData): HTMLElement {
  const commands: string[] = [];
  const input = data.case;
  if (input && (data.kind === "run" || data.kind === "family")) {
    const sets = data.kind === "run" ? input.overrides.map((o) => ` --set ${quoted(o)}`).join("") : "";
    commands.push(`meniscus run ${quoted(input.path)}${sets} --out ${quoted(data.folder)}`);
  }
  if (data.kind === "comparison") {
    const parts = (data.comparison?.parts ?? []).map((p) => quoted(p.name)).join(" ");
    commands.push(`meniscus compare ${parts} --out ${quoted(data.folder)}`);
  }
  commands.push(`meniscus report ${quoted(data.folder)}`);
  const program = data.result?.program_version ?? data.comparison?.program_version;
  const facts = [
    program ? `Made by Meniscus ${program}.` : "",
    data.result?.case_hash ? `Fingerprint of the case: ${data.result.case_hash}.` : "",
    data.kind === "run" ? "The same program on the same kind of processor gives the same bits, for any number of threads." : "",
  ].filter((t) => t !== "");
  return section(
    "again",
    "How to make it again",
    h("pre", {}, commands.join("\n")),
    h("p", {}, facts.join(" ")),
    h("details", {}, h("summary", {}, "Versions of the program and its libraries"), h("pre", {}, data.versions)),
  );
}
