import type { PageData } from "./data";
import { h, section, table } from "./dom";
import { count, number, quantity, words } from "./format";

/** The figures of a film alone: its energy, bodies, and what was asked for. */
export function filmSection(data: PageData): HTMLElement | null {
  const film = data.result?.film;
  if (!film || data.kind !== "film") {
    return null;
  }
  const units = data.result?.units;
  const of = (unit: string | undefined) => unit ?? "";
  const length = of(units?.length);
  const energy = units ? `${units.force}\u00b7${units.length}` : "";
  const neck = film.neck_position?.map((x) => number(x, 3)).join(", ");
  const rows: string[][] = [
    ["verdict", film.verdict],
    ["area", quantity(film.area, length ? `${length}\u00b2` : "")],
    ["energy", quantity(film.energy, energy)],
    ["facets", `${count(film.facets)} between ${count(film.vertices)} vertices`],
    ...(film.smallest_neck
      ? [["smallest neck (radius)", `${quantity(film.smallest_neck, length)}${neck ? ` at (${neck})` : ""}`]]
      : []),
    ...Object.entries(data.quantities ?? {}).map(([name, value]) => [words(name), number(value)]),
  ];
  const bodies = Object.entries(film.bodies);
  return section(
    "film-figures",
    "The film in figures",
    table("Figures of the film", [{ head: "" }, { head: "found" }], rows),
    bodies.length > 0
      ? table(
          "Bodies that the films enclose",
          [{ head: "body" }, { head: "volume", numeric: true }, { head: "pressure", numeric: true }],
          bodies.map(([name, body]) => [
            words(name),
            quantity(body.volume, length ? `${length}\u00b3` : ""),
            quantity(body.pressure, of(units?.pressure)),
          ]),
        )
      : null,
    units ? null : h("p", { class: "hint" }, "A datafile has no units, so neither have these figures."),
  );
}
