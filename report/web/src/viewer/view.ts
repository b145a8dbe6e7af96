import * as THREE from "three";
import { mapGradient, MAPS, type MapName } from "../colours";
import type { PageData, Units } from "../data";
import { h } from "../dom";
import { number, quantity, words } from "../format";
import { caseFieldInfos, fieldInfos, middleRange, rangeOf, type FieldInfo } from "./fields";
import { historyControl } from "./history";
import { Model } from "./model";
import { mapTexture, type Shared } from "./shading";
import { Stage, VIEWS } from "./stage";

const USUAL_DEFLECTION = 0.05; // of the part's size
const MOST_DEFLECTION = 0.2;
const STEPS = 1000; // of a slider

type Axis = "" | "x" | "y" | "z";
const NORMALS: Record<Exclude<Axis, "">, [number, number, number]> = {
  x: [1, 0, 0],
  y: [0, -1, 0], // the half nearer to the usual view goes
  z: [0, 0, 1],
};

/** The 3-D view with its controls. */
class View {
  private readonly shared: Shared = {
    deflection: { value: 0 },
    plane: { value: new THREE.Vector4(1, 0, 0, 0) },
    cut: { value: 0 },
    range: { value: new THREE.Vector2(0, 1) },
    map: { value: mapTexture("viridis") },
  };
  private readonly overlay = h("div", { class: "overlay", "aria-hidden": true });
  private readonly stage: Stage;
  private readonly model: Model;
  private readonly infos: FieldInfo[];
  private field: FieldInfo | null;
  private map: MapName = "viridis";
  private axis: Axis = "";
  private level = 0.5;
  private flipped = false;
  private edges = false;
  private filmShown = false;
  private filmEdges = false;
  private frame: number | null = null;
  private readonly bar = h("div", { class: "bar" });
  private readonly low = h("input", { type: "number", step: "any", "aria-label": "least value of the colours" });
  private readonly high = h("input", { type: "number", step: "any", "aria-label": "largest value of the colours" });

  constructor(
    private readonly data: PageData,
    units: Units,
    canvas: HTMLCanvasElement,
    readonly element: HTMLElement,
  ) {
    this.stage = new Stage(canvas);
    this.model = new Model(data, this.shared, this.stage, this.overlay);
    const keys = this.model.panes.flatMap((p) => [...(p.part?.mesh.fields.keys() ?? [])]);
    const infos = [...fieldInfos(units), ...caseFieldInfos([...new Set(keys)], units)];
    this.infos = infos.filter((info) =>
      info.on === "film"
        ? this.model.film !== null
        : this.model.panes.some((p) => p.part?.mesh.fields.has(info.key)),
    );
    this.field = this.infos[0] ?? null;
    const frameBox = h(
      "div",
      { class: "canvas-frame" },
      canvas,
      this.overlay,
      this.bar,
    );
    this.paneTitles(frameBox);
    const hint =
      "Drag to turn, with the right button to move; after a click the wheel " +
      "zooms. Arrow keys turn, + and \u2212 zoom, 0 resets.";
    element.append(
      h("div", {}, frameBox, h("p", { class: "hint" }, hint)),
      this.panel(),
    );
    this.usualRange();
    this.refresh();
    this.stage.look(VIEWS.Oblique);
    document.addEventListener("meniscus-look", () => this.stage.draw());
  }

  private paneTitles(frame: HTMLElement): void {
    if (this.model.panes.length < 2) {
      return;
    }
    // Small panes are of no use: room for more than one row of them.
    const many = Math.ceil(this.model.panes.length / 6);
    frame.style.height = many > 2 ? `${Math.min(1600, 240 * many)}px` : "";
    // Members may each have a worst load case of their own.
    const cases = new Set(this.data.parts.map((p) => p.mesh.load_case));
    this.model.panes.forEach((pane, k) => {
      const of = this.data.parts[k]?.mesh.load_case;
      const name = cases.size > 1 && of ? `${pane.name}, ${of.replace(/_/g, " ")}` : pane.name;
      const link = this.data.parts[k]?.link;
      const title = link
        ? h("a", { href: link, class: "pane-title" }, name)
        : h("span", { class: "pane-title" }, name);
      this.stage.titles.push(title);
      this.overlay.append(title);
    });
    this.overlay.removeAttribute("aria-hidden");
  }

  private panel(): HTMLElement {
    return h(
      "form",
      {
        class: "panel",
        "aria-label": "Controls of the 3-D view",
        onsubmit: (event) => event.preventDefault(),
      },
      this.viewButtons(),
      this.colourControls(),
      this.deflectionControls(),
      this.sectionControls(),
      this.shownControls(),
      this.pushControls(),
      historyControl(this.data, (index) => {
        this.frame = index;
        this.model.showFrame(index);
        this.refresh();
      }),
    );
  }

  private viewButtons(): HTMLElement {
    const buttons = Object.entries(VIEWS).map(([name, from]) =>
      h(
        "button",
        { type: "button", onclick: () => this.stage.look(from) },
        name,
      ),
    );
    return h(
      "fieldset",
      {},
      h("legend", {}, "View"),
      h(
        "div",
        { class: "buttons" },
        ...buttons,
        h("button", { type: "button", "aria-label": "zoom in", onclick: () => this.stage.zoom(0.85) }, "+"),
        h("button", { type: "button", "aria-label": "zoom out", onclick: () => this.stage.zoom(1 / 0.85) }, "\u2212"),
      ),
    );
  }

  private colourControls(): HTMLElement | null {
    if (this.field === null) {
      return null;
    }
    const select = h(
      "select",
      {
        id: "field",
        onchange: () => {
          this.field = this.infos.find((i) => i.key === select.value) ?? null;
          this.usualRange();
          this.refresh();
        },
      },
      ...this.infos.map((info) => h("option", { value: info.key }, info.label)),
    );
    const map = h(
      "select",
      {
        id: "map",
        onchange: () => {
          this.map = map.value as MapName;
          this.shared.map.value.dispose();
          this.shared.map.value = mapTexture(this.map);
          this.refresh();
        },
      },
      ...MAPS.map((name) => h("option", { value: name }, name)),
    );
    for (const input of [this.low, this.high]) {
      input.addEventListener("change", () => {
        this.shared.range.value.set(
          input === this.low ? Number(this.low.value) : this.shared.range.value.x,
          input === this.high ? Number(this.high.value) : this.shared.range.value.y,
        );
        this.refresh();
      });
    }
    return h(
      "fieldset",
      {},
      h("legend", {}, "Colours"),
      h("label", { class: "row" }, "show", select),
      h("label", { class: "row" }, "map", map),
      h(
        "div",
        { class: "row" },
        h("span", {}, "from"),
        this.low,
        h("span", {}, "to"),
        this.high,
      ),
      h(
        "div",
        { class: "buttons" },
        h("button", { type: "button", id: "full-range", onclick: () => { this.fullRange(); this.refresh(); } }, "Full range"),
        h(
          "button",
          {
            type: "button",
            id: "middle-range",
            title: "Leaves the outermost 1 % at either end out, such as peaks at clamps",
            onclick: () => { this.usualRange(); this.refresh(); },
          },
          "Without peaks",
        ),
      ),
    );
  }

  private deflectionControls(): HTMLElement | null {
    const most = this.model.scaleFor(MOST_DEFLECTION);
    if (most <= 0) {
      return null;
    }
    const output = h("output", {});
    const slider = h("input", { type: "range", id: "deflection", min: 0, max: STEPS, step: 1, "aria-label": "deflection scale" });
    const set = (scale: number) => {
      this.shared.deflection.value = scale;
      output.textContent = `\u00d7 ${number(scale, 3)}`;
      slider.setAttribute("aria-valuetext", `times ${number(scale, 3)}`);
      this.stage.draw();
    };
    const put = (scale: number) => {
      slider.value = String(Math.round((STEPS * scale) / most));
      set(scale);
    };
    slider.addEventListener("input", () => set((most * Number(slider.value)) / STEPS));
    put(this.model.scaleFor(USUAL_DEFLECTION));
    return h(
      "fieldset",
      {},
      h("legend", {}, "Deflection, magnified"),
      h("div", { class: "row" }, slider, output),
      h(
        "div",
        { class: "buttons" },
        h("button", { type: "button", onclick: () => put(0) }, "None"),
        h("button", { type: "button", onclick: () => put(1) }, "True"),
        h("button", { type: "button", onclick: () => put(this.model.scaleFor(USUAL_DEFLECTION)) }, "Clear to see"),
      ),
    );
  }

  private sectionControls(): HTMLElement {
    const slider = h("input", { type: "range", id: "section-level", min: 0, max: STEPS, step: 1, value: STEPS / 2, disabled: true, "aria-label": "place of the section" });
    const flip = h("input", { type: "checkbox", id: "section-flip", disabled: true });
    const axis = h(
      "select",
      {
        id: "section-axis",
        onchange: () => {
          this.axis = axis.value as Axis;
          slider.disabled = flip.disabled = this.axis === "";
          this.refresh();
        },
      },
      h("option", { value: "" }, "none"),
      ...(["x", "y", "z"] as const).map((name) => h("option", { value: name }, `across ${name}`)),
    );
    slider.addEventListener("input", () => {
      this.level = Number(slider.value) / STEPS;
      this.refresh();
    });
    flip.addEventListener("change", () => {
      this.flipped = flip.checked;
      this.refresh();
    });
    return h(
      "fieldset",
      {},
      h("legend", {}, "Section"),
      h("label", { class: "row" }, "plane", axis),
      h("div", { class: "row" }, slider),
      h("label", {}, flip, " other half"),
    );
  }

  private check(id: string, text: string, on: boolean, change: (on: boolean) => void): HTMLElement {
    const box = h("input", { type: "checkbox", id, checked: on, onchange: () => { change(box.checked); this.refresh(); } });
    return h("label", {}, box, ` ${text}`);
  }

  private shownControls(): HTMLElement {
    const model = this.model;
    return h(
      "fieldset",
      {},
      h("legend", {}, "Show"),
      model.panes.some((p) => p.part)
        ? this.check("edges", "element edges", false, (on) => (this.edges = on))
        : null,
      model.film ? this.check("film", "film", false, (on) => (this.filmShown = on)) : null,
      model.film ? this.check("film-edges", "film facets", false, (on) => (this.filmEdges = on)) : null,
      model.curves.children.length > 0
        ? this.check("curves", "boundary curves", true, (on) => (model.curves.visible = on))
        : null,
      model.loadLabels.length > 0
        ? this.check("loads", "loads and supports", true, (on) => {
            model.loads.visible = on;
            model.loadLabels.forEach((l) => (l.hidden = !on));
          })
        : null,
    );
  }

  private pushControls(): HTMLElement | null {
    if (this.model.pushes.length === 0) {
      return null;
    }
    const select = h(
      "select",
      {
        id: "push",
        onchange: () => {
          this.model.showPush(select.value === "" ? null : Number(select.value));
          this.stage.draw();
        },
      },
      h("option", { value: "" }, "no arrows"),
      ...this.model.pushes.map((push, k) => h("option", { value: k }, `to ${words(push.label)}`)),
    );
    return h(
      "fieldset",
      {},
      h("legend", {}, "Push the curves this way"),
      h("label", { class: "row" }, select),
    );
  }

  private values(): (Float32Array | undefined)[] {
    const key = this.field?.key ?? "";
    return this.field?.on === "film"
      ? [this.model.film?.mesh.fields.get(key)]
      : this.model.panes.map((p) => p.part?.mesh.fields.get(key));
  }

  private fullRange(): void {
    this.setRange(rangeOf(this.values()));
  }

  /** What shows most: without the peaks of clamps and rims, from 0 on. */
  private usualRange(): void {
    const [low, high] = middleRange(this.values());
    this.setRange([low >= 0 && low < 0.4 * high ? 0 : low, high]);
  }

  private setRange(range: [number, number]): void {
    this.shared.range.value.set(range[0], range[1]);
  }

  /** Brings the scene to what the controls say. */
  private refresh(): void {
    const onFilm = this.field?.on === "film" && this.frame === null;
    const normal = this.axis === "" ? null : NORMALS[this.axis];
    this.shared.cut.value = normal ? 1 : 0;
    for (const pane of this.model.panes) {
      if (pane.part) {
        pane.part.group.visible = !onFilm && this.frame === null;
        pane.part.showField(this.field?.key ?? "");
        pane.part.showEdges(this.edges);
      }
      if (normal && pane === this.model.panes[0]) {
        const c = normal.findIndex((v) => v !== 0);
        const at = pane.box.low[c] + this.level * (pane.box.high[c] - pane.box.low[c]);
        const sign = this.flipped ? -1 : 1;
        this.shared.plane.value.set(sign * normal[0], sign * normal[1], sign * normal[2], sign * normal[c] * at);
      }
      const plane = this.shared.plane.value;
      pane.part?.showSection(
        [plane.x, plane.y, plane.z],
        normal ? plane.w : null,
        this.edges,
      );
    }
    if (this.model.film) {
      const plain = !onFilm && this.frame === null;
      this.model.film.group.visible = onFilm;
      this.model.filmBody!.visible = plain && this.filmShown && !this.filmEdges;
      this.model.filmEdges!.visible = (plain || onFilm) && this.filmEdges;
    }
    this.showBar();
    this.stage.draw();
  }

  private showBar(): void {
    this.bar.replaceChildren();
    this.bar.hidden = this.field === null || this.frame !== null;
    if (this.field === null) {
      return;
    }
    const { x: low, y: high } = this.shared.range.value;
    this.low.value = String(Number(low.toPrecision(4)));
    this.high.value = String(Number(high.toPrecision(4)));
    const strip = h("div", { class: "strip" });
    strip.style.background = mapGradient(this.map);
    const ticks = h("div", { class: "ticks" });
    const [least, most] = rangeOf(this.values());
    for (let k = 0; k <= 4; ++k) {
      const beyond = k === 4 && most > high * (1 + 1e-4) ? "\u2265 " : k === 0 && least < low - 1e-4 * (high - low) ? "\u2264 " : "";
      ticks.append(h("span", {}, beyond + number(low + ((high - low) * k) / 4, 3)));
    }
    const loadCase = this.model.panes[0]?.part?.mesh.loadCase;
    const of = this.field.on === "part" && loadCase ? `, load case \u201c${loadCase}\u201d` : "";
    this.bar.title = this.field.about;
    this.bar.append(
      h("div", {}, `${this.field.label} [${this.field.unit}]${of}`),
      strip,
      ticks,
      h("div", { class: "soft" }, `found: ${number(least, 3)} to ${quantity(most, this.field.unit)}`),
    );
    const text = `${this.field.label} from ${quantity(low, this.field.unit)} to ${quantity(high, this.field.unit)}`;
    this.stage.canvas.setAttribute(
      "aria-label",
      `3-D view of the part, coloured by ${text}. Arrow keys turn it, plus and minus zoom, 0 resets.`,
    );
  }
}

/** The view, or a note where the browser cannot draw in 3-D. */
export function view3d(data: PageData, units: Units): HTMLElement {
  const element = h("div", { class: "view" });
  const canvas = h("canvas", { tabindex: 0, role: "img", "aria-label": "3-D view of the part" });
  if (data.parts.length === 0 && !data.film && !data.findings) {
    element.append(h("p", { class: "hint" }, "There is no shape to show: the run ended before it had one."));
    return element;
  }
  // Sizes must be known before the camera is set.
  requestAnimationFrame(() => {
    try {
      const probe = document.createElement("canvas").getContext("webgl2");
      if (probe === null) {
        throw new Error("the browser offers no WebGL 2");
      }
      probe.getExtension("WEBGL_lose_context")?.loseContext();
      new View(data, units, canvas, element);
    } catch (error) {
      console.info(`No 3-D view: ${String(error)}`);
      element.replaceChildren(
        h(
          "p",
          { class: "notice", id: "no-webgl" },
          "This browser cannot draw in 3-D (WebGL is missing or switched off). Tables and plots below are complete; the part can be opened from part.vtu with ParaView.",
        ),
      );
    }
  });
  return element;
}
