import { convergenceSection } from "./convergence";
import type { PageData } from "./data";
import { h, section } from "./dom";
import { filmSection } from "./film";
import { ledgerSection } from "./ledger";
import { comparisonSection, familySection } from "./members";
import { caseSection, reproduceSection } from "./source";
import { eigenSection, stressSection } from "./stress";
import { frontSection, sensitivitySection, sweepSection, toleranceSection } from "./studies";
import { answerSection, checksSection, headline, keyFigures } from "./summary";
import { view3d } from "./viewer/view";

const VIEW_TITLES = {
  run: "The part",
  film: "The film",
  family: "The parts, with one camera and one colour scale",
  comparison: "The parts, with one camera and one colour scale",
};
const NO_UNITS = { system: "", length: "length", force: "force", pressure: "pressure", mass: "mass" };

function notes(data: PageData): HTMLElement | null {
  const frames = data.frames;
  const texts = [
    ...(data.notes ?? []),
    ...data.parts.flatMap((p) => (p.note ? [data.parts.length > 1 ? `${p.name}: ${p.note}` : p.note] : [])),
    ...(frames && frames.frames.length < frames.stored
      ? [`Of ${frames.stored} stored designs ${frames.frames.length} are shown.`]
      : []),
  ];
  return texts.length > 0 ? h("ul", { class: "hint" }, ...texts.map((t) => h("li", {}, t))) : null;
}

const MOST_FAULTS = 50;

function faults(data: PageData): HTMLElement | null {
  const messages = data.findings?.messages ?? [];
  return messages.length > 0
    ? h(
        "div",
        {},
        h("p", {}, `The closed surface could not be filled with elements; red marks show where (${messages.length} found).`),
        h(
          "details",
          {},
          h("summary", {}, messages.length > MOST_FAULTS ? `The first ${MOST_FAULTS} of them` : "All of them"),
          h("ul", {}, ...messages.slice(0, MOST_FAULTS).map((m) => h("li", {}, m))),
        ),
      )
    : null;
}

/** All sections that the data have something for, with a menu of them. */
export function showPage(root: HTMLElement, data: PageData): void {
  const units = data.result?.units ?? data.comparison?.units ?? NO_UNITS;
  const sections = [
    section(
      "view",
      VIEW_TITLES[data.kind],
      view3d(data, units),
      faults(data),
      notes(data),
    ),
    filmSection(data),
    comparisonSection(data),
    familySection(data),
    answerSection(data),
    sweepSection(data),
    frontSection(data),
    toleranceSection(data),
    convergenceSection(data),
    data.kind === "run" ? stressSection(data) : null,
    data.kind === "run" ? eigenSection(data) : null,
    sensitivitySection(data),
    checksSection(data),
    ledgerSection(data),
    caseSection(data),
    reproduceSection(data),
  ].filter((s) => s !== null);
  const menu = h(
    "nav",
    { "aria-label": "Sections" },
    ...sections.map((s) => h("a", { href: `#${s.id}` }, s.querySelector("h2")!.textContent!)),
  );
  menu.querySelectorAll("a")[0].textContent = VIEW_TITLES[data.kind].split(",")[0];
  const head = headline(data);
  const figures = keyFigures(data);
  root.append(head, menu, ...(figures ? [figures] : []), ...sections);
}
