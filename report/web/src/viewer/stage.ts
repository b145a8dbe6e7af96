import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Pane } from "./pane";

/** A text that stays at a place of a pane. */
export interface Label {
  pane: Pane;
  at: THREE.Vector3;
  element: HTMLElement;
}

export const VIEWS: Record<string, [number, number, number]> = {
  Oblique: [0.42, -1, 0.55],
  Front: [0, -1, 0],
  Side: [1, 0, 0],
  Top: [0, -0.0005, 1],
};

const FIELD = 28; // degrees
const TURN = Math.PI / 24; // per key

/** Canvas, camera and panes: draws when something changed, not before. */
export class Stage {
  readonly canvas: HTMLCanvasElement;
  readonly panes: Pane[] = [];
  readonly labels: Label[] = [];
  /** Of the panes in their order: each stands over its own. */
  readonly titles: HTMLElement[] = [];
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.PerspectiveCamera(FIELD, 1, 0.1, 10);
  private readonly controls: OrbitControls;
  private asked = false;
  private radius = 1;
  private looked = false; // with the canvas at its size

  /** Throws where the browser has no WebGL. */
  constructor(canvas: HTMLCanvasElement) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({
      canvas,
      antialias: true,
      alpha: true,
      preserveDrawingBuffer: true, // a print copies the canvas
    });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.autoClear = false;
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    THREE.ColorManagement.enabled = false;
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    // Whoever only scrolls past must not zoom.
    this.controls.enableZoom = false;
    const zooms = (on: boolean) => () => (this.controls.enableZoom = on);
    canvas.addEventListener("pointerdown", zooms(true), { capture: true });
    canvas.addEventListener("focus", zooms(true));
    canvas.addEventListener("blur", zooms(false));
    this.controls.addEventListener("change", () => this.draw());
    canvas.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  add(pane: Pane): void {
    this.panes.push(pane);
    this.scene.add(pane.root);
    this.radius = Math.max(...this.panes.map((p) => p.box.radius));
  }

  /** Columns and rows of panes. */
  grid(): [number, number] {
    const n = Math.max(1, this.panes.length);
    const aspect = this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight);
    let best: [number, number] = [n, 1];
    let size = 0;
    for (let columns = 1; columns <= n; ++columns) {
      const rows = Math.ceil(n / columns);
      const cell = Math.min((aspect * 0.8) / columns, 1 / rows);
      if (cell > size) {
        size = cell;
        best = [columns, rows];
      }
    }
    return best;
  }

  look(from: [number, number, number]): void {
    const [columns, rows] = this.grid();
    const aspect =
      ((this.canvas.clientWidth / columns) * rows) /
      Math.max(1, this.canvas.clientHeight);
    const half = (0.5 * FIELD * Math.PI) / 180;
    const fit = Math.min(half, Math.atan(Math.tan(half) * aspect));
    const distance = (0.86 * this.radius) / Math.sin(fit);
    this.camera.position
      .set(...from)
      .normalize()
      .multiplyScalar(distance);
    this.camera.near = distance / 50;
    this.camera.far = distance * 20;
    this.controls.target.set(0, 0, 0);
    this.controls.minDistance = distance / 30;
    this.controls.maxDistance = distance * 6;
    this.controls.update();
    this.draw();
  }

  zoom(factor: number): void {
    const target = this.controls.target;
    this.camera.position.sub(target).multiplyScalar(factor).add(target);
    this.controls.update();
    this.draw();
  }

  turn(sideways: number, upwards: number): void {
    const target = this.controls.target;
    const away = this.camera.position.clone().sub(target);
    const s = new THREE.Spherical().setFromVector3(
      new THREE.Vector3(away.x, away.z, -away.y),
    );
    s.theta += sideways;
    s.phi = Math.min(Math.PI - 0.01, Math.max(0.01, s.phi + upwards));
    const v = new THREE.Vector3().setFromSpherical(s);
    this.camera.position.set(v.x, -v.z, v.y).add(target);
    this.controls.update();
    this.draw();
  }

  private key(event: KeyboardEvent): void {
    const actions: Record<string, () => void> = {
      ArrowLeft: () => this.turn(-TURN, 0),
      ArrowRight: () => this.turn(TURN, 0),
      ArrowUp: () => this.turn(0, -TURN),
      ArrowDown: () => this.turn(0, TURN),
      "+": () => this.zoom(0.9),
      "=": () => this.zoom(0.9),
      "-": () => this.zoom(1 / 0.9),
      "0": () => this.look(VIEWS.Oblique),
    };
    const action = actions[event.key];
    if (action && !event.ctrlKey && !event.metaKey && !event.altKey) {
      action();
      event.preventDefault();
    }
  }

  draw(): void {
    if (!this.asked) {
      this.asked = true;
      requestAnimationFrame(() => {
        this.asked = false;
        this.drawNow();
      });
    }
  }

  private drawNow(): void {
    const width = this.canvas.clientWidth;
    const height = this.canvas.clientHeight;
    if (width === 0 || height === 0) {
      return;
    }
    if (!this.looked) {
      this.looked = true;
      this.look(VIEWS.Oblique);
    }
    this.renderer.setSize(width, height, false);
    this.renderer.setScissorTest(false);
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.clear();
    this.renderer.setScissorTest(true);
    const [columns, rows] = this.grid();
    const w = width / columns;
    const h = height / rows;
    this.camera.aspect = w / h;
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    this.panes.forEach((pane, k) => {
      const x = (k % columns) * w;
      const y = Math.floor(k / columns) * h;
      this.renderer.setViewport(x, height - y - h, w, h);
      this.renderer.setScissor(x, height - y - h, w, h);
      for (const other of this.panes) {
        other.root.visible = other === pane;
      }
      this.renderer.render(this.scene, this.camera);
      this.place(pane, x, y, w, h);
      const title = this.titles[k];
      if (title) {
        title.style.left = `${x}px`;
        title.style.top = `${y}px`;
        title.style.maxWidth = `${w}px`;
      }
    });
    this.canvas.dataset.drawn = String(
      Number(this.canvas.dataset.drawn ?? "0") + 1,
    );
  }

  private place(pane: Pane, x: number, y: number, w: number, h: number): void {
    for (const label of this.labels) {
      if (label.pane !== pane) {
        continue;
      }
      const at = label.at.clone().add(pane.root.position).project(this.camera);
      const left = x + 0.5 * (at.x + 1) * w;
      const top = y + 0.5 * (1 - at.y) * h;
      label.element.style.transform = `translate(-50%, -50%) translate(${left}px, ${top}px)`;
    }
  }
}
