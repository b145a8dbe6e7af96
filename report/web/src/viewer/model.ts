import * as THREE from "three";
import {
  unpackReals,
  type LoadCase,
  type PageData,
  type Units,
} from "../data";
import { h } from "../dom";
import { quantity } from "../format";
import { centreOf, filmOf, meshOf, surfaceOf } from "./mesh";
import { arrow, curveLine, curvePieces, Pane, plainSurface, ShownMesh } from "./pane";
import { pushesOf, type Push } from "./pushes";
import type { Shared } from "./shading";
import type { Stage } from "./stage";

const CURVE = "#d55e00";
const FILM = "#8fb7d6";
const FORCE = "#b3261e";
const PUSH = "#009e73";
const ARROWS_PER_CURVE = 12;

/** What a page shows in 3-D, ready to be switched on and off. */
export class Model {
  readonly panes: Pane[] = [];
  film: ShownMesh | null = null;
  filmBody: THREE.Group | null = null;
  filmEdges: THREE.Group | null = null;
  readonly curves = new THREE.Group();
  readonly loads = new THREE.Group();
  readonly pushGroup = new THREE.Group();
  readonly loadLabels: HTMLElement[] = [];
  readonly pushes: Push[];
  readonly deflections: number[] = [];
  private readonly frameGroup = new THREE.Group();

  constructor(
    private readonly data: PageData,
    private readonly shared: Shared,
    private readonly stage: Stage,
    private readonly overlay: HTMLElement,
  ) {
    for (const part of data.parts) {
      const mesh = meshOf(part.mesh);
      const shown = new ShownMesh(mesh, shared);
      this.panes.push(new Pane(part.name, mesh.nodes, shown));
      const size = mesh.fields.get("displacement");
      this.deflections.push(
        size ? size.reduce((most, v) => Math.max(most, v), 0) : 0,
      );
    }
    this.pushes = pushesOf(data);
    this.addFindings();
    this.addFilm();
    this.addCurves();
    this.addLoads();
    const main = this.panes[0];
    main?.root.add(this.curves, this.loads, this.pushGroup, this.frameGroup);
    this.panes.forEach((pane) => stage.add(pane));
  }

  get empty(): boolean {
    return this.panes.length === 0;
  }

  private addFilm(): void {
    if (!this.data.film) {
      return;
    }
    const film = filmOf(this.data.film);
    if (this.panes.length === 0) {
      this.panes.push(new Pane("film", film.nodes, null));
    }
    this.film = new ShownMesh(film, this.shared);
    this.film.showField("mean_curvature");
    this.filmBody = plainSurface(film, this.shared, FILM, 0.35);
    this.filmEdges = plainSurface(film, this.shared, FILM, 0.35, true);
    this.panes[0].root.add(this.film.group, this.filmBody, this.filmEdges);
  }

  private addFindings(): void {
    const findings = this.data.findings;
    if (!findings) {
      return;
    }
    const nodes = unpackReals(findings.nodes);
    const surface = findings.surface ? surfaceOf(findings.surface) : null;
    const pane = new Pane("surface at fault", surface?.nodes ?? nodes, null);
    if (surface) {
      pane.root.add(plainSurface(surface, this.shared, FILM, 0.4, true));
    }
    const fault = surfaceOf({
      nodes: findings.nodes,
      triangles: findings.triangles,
      labels: { type: "u8", data: "" },
      names: ["fault"],
    });
    fault.labels = new Uint32Array(fault.triangles.length / 3);
    if (fault.triangles.length > 0) {
      pane.root.add(plainSurface(fault, this.shared, "#d00000", 1, true));
    }
    for (const place of findings.places) {
      const ball = new THREE.Mesh(
        new THREE.SphereGeometry(0.012 * pane.box.radius, 12, 8),
        new THREE.MeshBasicMaterial({ color: "#d00000" }),
      );
      ball.position.fromArray(nodes, 3 * place);
      pane.root.add(ball);
    }
    this.panes.push(pane);
  }

  private addCurves(): void {
    this.curves.clear();
    for (const curve of this.data.curves ?? []) {
      const points = unpackReals(curve.points);
      this.curves.add(
        curve.pieces ? curvePieces(points, CURVE) : curveLine(points, CURVE),
      );
    }
  }

  private setCurves(curves: Float32Array[]): void {
    this.curves.clear();
    for (const points of curves) {
      this.curves.add(curveLine(points, CURVE));
    }
  }

  private addLoads(): void {
    const pane = this.panes[0];
    const loadCase = this.shownLoadCase();
    const surface = pane?.part?.mesh;
    if (!loadCase || !surface) {
      return;
    }
    const sizes = loadCase.items.map((item) =>
      item.kind === "force" && item.vector ? Math.hypot(...item.vector) : 0,
    );
    const largest = Math.max(...sizes, 1e-300);
    loadCase.items.forEach((item, k) => {
      const centre = centreOf(surface, item.on);
      if (!centre) {
        return;
      }
      // What several surfaces carry together acts at its point.
      const shared = item.on.length > 1;
      const at = new THREE.Vector3(...((shared && item.at) || centre));
      if (shared) {
        const lines = item.on.flatMap((name) => {
          const carrier = centreOf(surface, [name]);
          return carrier ? [...at.toArray(), ...carrier] : [];
        });
        this.loads.add(curvePieces(new Float32Array(lines), FORCE));
      }
      const text =
        item.kind === "force"
          ? quantity(sizes[k], loadCase.unit)
          : item.kind === "support"
            ? "held"
            : item.kind;
      if (item.kind === "force" && item.vector && sizes[k] > 0) {
        const by = new THREE.Vector3(...item.vector)
          .normalize()
          .multiplyScalar(
            pane.box.radius * (0.14 + (0.22 * sizes[k]) / largest),
          );
        const tail = at.clone().sub(by);
        this.loads.add(arrow(tail, by, 0.018 * pane.box.radius, FORCE));
        this.label(tail.clone().addScaledVector(by, -0.12), text, "force");
      } else {
        this.label(at, text, "support");
      }
    });
  }

  private shownLoadCase(): LoadCase | undefined {
    const name = this.data.parts[0]?.mesh.load_case;
    const cases = this.data.loads ?? [];
    return cases.find((c) => c.name === name) ?? cases[0];
  }

  private label(at: THREE.Vector3, text: string, kind: string): void {
    const element = h("span", { class: `tag ${kind}` }, text);
    this.overlay.append(element);
    this.loadLabels.push(element);
    this.stage.labels.push({ pane: this.panes[0], at, element });
  }

  showPush(index: number | null): void {
    this.pushGroup.clear();
    const push = index === null ? undefined : this.pushes[index];
    if (!push) {
      return;
    }
    let largest = 0;
    for (const { motion } of push.curves) {
      for (let i = 0; i < motion.length; i += 3) {
        largest = Math.max(
          largest,
          Math.hypot(motion[i], motion[i + 1], motion[i + 2]),
        );
      }
    }
    const radius = this.panes[0].box.radius;
    for (const { points, motion } of push.curves) {
      const count = points.length / 3;
      for (let k = 0; k < ARROWS_PER_CURVE; ++k) {
        const i = 3 * Math.floor((k * count) / ARROWS_PER_CURVE);
        const by = new THREE.Vector3(motion[i], motion[i + 1], motion[i + 2]);
        if (by.length() > 0.02 * largest) {
          by.multiplyScalar((0.24 * radius) / largest);
          const from = new THREE.Vector3().fromArray(points, i);
          this.pushGroup.add(arrow(from, by, 0.011 * radius, PUSH));
        }
      }
    }
  }

  /** An earlier design's film and curves instead of the part; null: none. */
  showFrame(index: number | null): void {
    this.frameGroup.clear();
    const frames = this.data.frames?.frames ?? [];
    const frame = index === null ? undefined : frames[index];
    const triangles = frames
      .slice(0, (index ?? -1) + 1)
      .reverse()
      .find((f) => f.surface)?.surface;
    if (!frame || !triangles) {
      this.addCurves();
      return;
    }
    const surface = surfaceOf({ ...triangles, nodes: frame.nodes });
    this.frameGroup.add(plainSurface(surface, this.shared, FILM, 1, true));
    if (frame.curves) {
      this.setCurves(frame.curves.map(unpackReals));
    }
  }

  /** Deflection that moves the farthest point by `part` of the size. */
  scaleFor(part: number): number {
    const largest = Math.max(...this.deflections, 0);
    const size = Math.max(...this.panes.map((p) => 2 * p.box.radius), 0);
    return largest > 0 ? (part * size) / largest : 0;
  }
}

export type { Units };
