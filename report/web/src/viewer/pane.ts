import * as THREE from "three";
import {
  boxOf,
  faceEdges,
  rimEdges,
  sectionOf,
  splitByLabel,
  type Box,
  type Mesh,
  type Surface,
} from "./mesh";
import {
  fieldMaterial,
  lineMaterial,
  plainMaterial,
  type Shared,
} from "./shading";

/** NaN does not pass through every driver; this stands for it. */
const NO_VALUE = -2e30;

function geometryOf(
  nodes: Float32Array,
  displacement: Float32Array | null,
  pick?: Uint32Array,
): THREE.BufferGeometry {
  const count = pick ? pick.length : nodes.length / 3;
  const at = new Float32Array(3 * count);
  const moved = new Float32Array(3 * count);
  for (let i = 0; i < count; ++i) {
    const id = pick ? pick[i] : i;
    for (let c = 0; c < 3; ++c) {
      at[3 * i + c] = nodes[3 * id + c];
      moved[3 * i + c] = displacement ? displacement[3 * id + c] : 0;
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(at, 3));
  geometry.setAttribute("displacement", new THREE.BufferAttribute(moved, 3));
  return geometry;
}

function lines(
  nodes: Float32Array,
  displacement: Float32Array | null,
  pairs: Uint32Array,
  material: THREE.Material,
): THREE.LineSegments {
  return new THREE.LineSegments(
    geometryOf(nodes, displacement, pairs),
    material,
  );
}

/** A mesh with what can be shown of it: colours, edges, rims, its section. */
export class ShownMesh {
  readonly group = new THREE.Group();
  readonly mesh: Mesh;
  private readonly shared: Shared;
  private readonly surface: THREE.Mesh;
  private readonly node: Uint32Array;
  private edges: THREE.LineSegments | null = null;
  private readonly cap = new THREE.Group();
  private field = "";

  constructor(mesh: Mesh, shared: Shared) {
    this.mesh = mesh;
    this.shared = shared;
    const split = splitByLabel(mesh);
    this.node = split.node;
    const geometry = geometryOf(mesh.nodes, mesh.displacement, split.node);
    geometry.setIndex(new THREE.BufferAttribute(split.index, 1));
    geometry.computeVertexNormals();
    geometry.setAttribute(
      "value",
      new THREE.BufferAttribute(
        new Float32Array(split.node.length).fill(NO_VALUE),
        1,
      ),
    );
    this.surface = new THREE.Mesh(geometry, fieldMaterial(shared));
    this.surface.frustumCulled = false;
    const rims = lines(
      mesh.nodes,
      mesh.displacement,
      rimEdges(mesh),
      lineMaterial(shared, "#1c2733"),
    );
    rims.frustumCulled = false;
    this.group.add(this.surface, rims, this.cap);
  }

  values(): Float32Array | undefined {
    return this.mesh.fields.get(this.field);
  }

  showField(name: string): void {
    this.field = name;
    const values = this.values();
    const shown = this.surface.geometry.getAttribute(
      "value",
    ) as THREE.BufferAttribute;
    for (let i = 0; i < this.node.length; ++i) {
      const value = values ? values[this.node[i]] : NaN;
      shown.array[i] = Number.isFinite(value) ? value : NO_VALUE;
    }
    shown.needsUpdate = true;
  }

  showEdges(on: boolean): void {
    if (on && this.edges === null) {
      this.edges = lines(
        this.mesh.nodes,
        this.mesh.displacement,
        faceEdges(this.mesh),
        lineMaterial(this.shared, "#10161d", 0.45),
      );
      this.edges.frustumCulled = false;
      this.group.add(this.edges);
    }
    if (this.edges !== null) {
      this.edges.visible = on;
    }
  }

  /** The cut face where the mesh has elements inside; none without `level`. */
  showSection(
    normal: [number, number, number],
    level: number | null,
    withEdges: boolean,
  ): void {
    for (const child of [...this.cap.children]) {
      (child as THREE.Mesh).geometry.dispose();
      this.cap.remove(child);
    }
    if (level === null || this.mesh.tets === null) {
      return;
    }
    const section = sectionOf(this.mesh, normal, level, this.values());
    const geometry = geometryOf(section.nodes, section.displacement);
    geometry.setIndex(new THREE.BufferAttribute(section.triangles, 1));
    const normals = new Float32Array(section.nodes.length);
    for (let i = 0; i < normals.length; ++i) {
      normals[i] = normal[i % 3];
    }
    geometry.setAttribute("normal", new THREE.BufferAttribute(normals, 3));
    const values = section.value.map((v) =>
      Number.isFinite(v) ? v : NO_VALUE,
    );
    geometry.setAttribute("value", new THREE.BufferAttribute(values, 1));
    // The cut face lies on the plane: rounding must not cut it away.
    const whole: Shared = { ...this.shared, cut: { value: 0 } };
    const face = new THREE.Mesh(geometry, fieldMaterial(whole));
    face.frustumCulled = false;
    this.cap.add(face);
    if (withEdges) {
      const edges = lines(
        section.nodes,
        section.displacement,
        section.edges,
        lineMaterial(whole, "#10161d", 0.6),
      );
      edges.frustumCulled = false;
      this.cap.add(edges);
    }
  }
}

/** A surface in one colour: a film, an earlier design, findings. */
export function plainSurface(
  surface: Surface,
  shared: Shared,
  colour: string,
  opacity = 1,
  edges = false,
): THREE.Group {
  const group = new THREE.Group();
  const split = splitByLabel(surface);
  const geometry = geometryOf(surface.nodes, null, split.node);
  geometry.setIndex(new THREE.BufferAttribute(split.index, 1));
  geometry.computeVertexNormals();
  const body = new THREE.Mesh(
    geometry,
    plainMaterial(shared, colour, opacity),
  );
  body.frustumCulled = false;
  group.add(body);
  const pairs = edges ? faceEdges(surface) : rimEdges(surface);
  const outline = lines(
    surface.nodes,
    null,
    pairs,
    lineMaterial(shared, "#1c2733", edges ? 0.5 : 1),
  );
  outline.frustumCulled = false;
  group.add(outline);
  return group;
}

/** Closed curves through their points. */
export function curveLine(
  points: Float32Array,
  colour: string,
): THREE.LineLoop {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(points, 3));
  const line = new THREE.LineLoop(
    geometry,
    new THREE.LineBasicMaterial({ color: colour }),
  );
  line.frustumCulled = false;
  return line;
}

/** A curve from its pieces' ends. */
export function curvePieces(
  ends: Float32Array,
  colour: string,
): THREE.LineSegments {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(ends, 3));
  const line = new THREE.LineSegments(
    geometry,
    new THREE.LineBasicMaterial({ color: colour }),
  );
  line.frustumCulled = false;
  return line;
}

/** A solid arrow from `from` along `by`, head included. */
export function arrow(
  from: THREE.Vector3,
  by: THREE.Vector3,
  thickness: number,
  colour: string,
): THREE.Group {
  const length = by.length();
  const head = Math.min(4.5 * thickness, 0.6 * length);
  const material = new THREE.MeshBasicMaterial({ color: colour });
  const shaft = new THREE.Mesh(
    new THREE.CylinderGeometry(0.5 * thickness, 0.5 * thickness, 1, 10),
    material,
  );
  shaft.scale.set(1, Math.max(length - head, 1e-9), 1);
  shaft.position.set(0, 0.5 * (length - head), 0);
  const tip = new THREE.Mesh(
    new THREE.ConeGeometry(1.5 * thickness, head, 14),
    material,
  );
  tip.position.set(0, length - 0.5 * head, 0);
  const group = new THREE.Group();
  group.add(shaft, tip);
  group.position.copy(from);
  group.quaternion.setFromUnitVectors(
    new THREE.Vector3(0, 1, 0),
    by.clone().normalize(),
  );
  return group;
}

/** A picture of its own in the view: one part around its centre. */
export class Pane {
  readonly root = new THREE.Group();
  readonly box: Box;
  readonly part: ShownMesh | null;
  readonly name: string;

  constructor(name: string, nodes: Float32Array, part: ShownMesh | null) {
    this.name = name;
    this.part = part;
    this.box = boxOf(nodes);
    this.root.position.set(
      -this.box.centre[0],
      -this.box.centre[1],
      -this.box.centre[2],
    );
    if (part) {
      this.root.add(part.group);
    }
  }
}
