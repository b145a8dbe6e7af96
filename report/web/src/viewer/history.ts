import type { PageData } from "../data";
import { h } from "../dom";
import { words } from "../format";
import { historyOf } from "../history";
import { responsesOf } from "../measures";
import { designRows } from "../rows";

/** A slider through the designs that the study looked at; null: none kept. */
export function historyControl(
  data: PageData,
  show: (frame: number | null) => void,
): HTMLElement | null {
  const frames = data.frames?.frames ?? [];
  if (frames.length === 0) {
    return null;
  }
  const rows = historyOf(data);
  const output = h("output", { class: "design-text", "aria-live": "polite" });
  const slider = h("input", {
    type: "range",
    id: "history",
    min: 0,
    max: frames.length,
    step: 1,
    value: frames.length,
    "aria-label": data.kind === "film" ? "step of the film's way to rest" : "design of the history",
  });
  const describe = (index: number): string => {
    if (index === frames.length) {
      return data.kind === "film" ? "the film at rest" : "the answer, with its stresses";
    }
    const caption = data.captions?.[frames[index].place];
    if (caption !== undefined) {
      return caption;
    }
    const evaluation = frames[index].evaluation;
    const row = rows.find((r) => r.evaluation === evaluation);
    const numbers = [
      ...designRows(data).map((d) => `${d.label} ${d.text(row?.values)}`),
      ...(data.case?.responses ?? []).map(
        (r) => `${words(r.name)} ${responsesOf(data).text(r.name, row?.values[r.name])}`,
      ),
    ];
    return `evaluation ${evaluation}: ${numbers.join(", ")}`;
  };
  const update = () => {
    const index = Number(slider.value);
    output.textContent = describe(index);
    slider.setAttribute("aria-valuetext", describe(index));
    show(index === frames.length ? null : index);
  };
  slider.addEventListener("input", update);
  output.textContent = describe(frames.length);
  return h(
    "fieldset",
    {},
    h("legend", {}, data.kind === "film" ? "The film's way to rest" : "Designs on the way"),
    h("div", { class: "row" }, slider),
    output,
  );
}
