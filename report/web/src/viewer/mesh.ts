import {
  unpackIds,
  unpackReals,
  type PackedFilm,
  type PackedMesh,
  type PackedReals,
  type PackedSurface,
} from "../data";

/** Nodes and triangles as the view draws them. */
export interface Surface {
  nodes: Float32Array;
  triangles: Uint32Array;
  labels: Uint32Array;
  names: string[];
}

export interface Mesh extends Surface {
  fourAFace: boolean;
  tets: Uint32Array | null;
  displacement: Float32Array | null;
  fields: Map<string, Float32Array>;
  loadCase: string;
}

export function surfaceOf(packed: PackedSurface): Surface {
  return {
    nodes: unpackReals(packed.nodes),
    triangles: unpackIds(packed.triangles),
    labels: unpackIds(packed.labels),
    names: packed.names,
  };
}

function fieldsOf(packed: Record<string, PackedReals>) {
  return new Map(
    Object.entries(packed).map(([name, field]) => [name, unpackReals(field)]),
  );
}

export function meshOf(packed: PackedMesh): Mesh {
  const displacement = packed.displacement
    ? unpackReals(packed.displacement)
    : null;
  const fields = fieldsOf(packed.fields);
  if (displacement) {
    const size = new Float32Array(displacement.length / 3);
    for (let i = 0; i < size.length; ++i) {
      size[i] = Math.hypot(
        displacement[3 * i],
        displacement[3 * i + 1],
        displacement[3 * i + 2],
      );
    }
    fields.set("displacement", size);
  }
  return {
    ...surfaceOf(packed),
    fourAFace: packed.four_a_face,
    tets: packed.tets ? unpackIds(packed.tets) : null,
    displacement,
    fields,
    loadCase: packed.load_case,
  };
}

export function filmOf(packed: PackedFilm): Mesh {
  return {
    ...surfaceOf(packed),
    fourAFace: false,
    tets: null,
    displacement: null,
    fields: fieldsOf(packed.fields),
    loadCase: "",
  };
}

/** Vertices split where surfaces meet, so that rims stay sharp. */
export interface SplitSurface {
  /** Node behind each vertex. */
  node: Uint32Array;
  index: Uint32Array;
}

export function splitByLabel(surface: Surface): SplitSurface {
  const seen = new Map<number, number>();
  const node: number[] = [];
  const index = new Uint32Array(surface.triangles.length);
  const names = Math.max(1, surface.names.length);
  for (let i = 0; i < index.length; ++i) {
    const id = surface.triangles[i];
    const key = id * names + surface.labels[Math.floor(i / 3)];
    let vertex = seen.get(key);
    if (vertex === undefined) {
      vertex = node.length;
      seen.set(key, vertex);
      node.push(id);
    }
    index[i] = vertex;
  }
  return { node: Uint32Array.from(node), index };
}

/** Edges of element faces as pairs of nodes, each once. */
export function faceEdges(mesh: Mesh | Surface): Uint32Array {
  const pairs: number[] = [];
  const t = mesh.triangles;
  const seen = new Set<number>();
  const count = mesh.nodes.length / 3;
  const add = (a: number, b: number) => {
    const key = Math.min(a, b) * count + Math.max(a, b);
    if (!seen.has(key)) {
      seen.add(key);
      pairs.push(a, b);
    }
  };
  if ("fourAFace" in mesh && mesh.fourAFace) {
    for (let k = 0; k < t.length; k += 12) {
      add(t[k], t[k + 1]);
      add(t[k + 2], t[k]);
      add(t[k + 3], t[k + 4]);
      add(t[k + 4], t[k + 5]);
      add(t[k + 7], t[k + 8]);
      add(t[k + 8], t[k + 6]);
    }
  } else {
    for (let k = 0; k < t.length; k += 3) {
      add(t[k], t[k + 1]);
      add(t[k + 1], t[k + 2]);
      add(t[k + 2], t[k]);
    }
  }
  return Uint32Array.from(pairs);
}

/** Edges between triangles of two surfaces, or of one triangle only. */
export function rimEdges(surface: Surface): Uint32Array {
  const t = surface.triangles;
  const count = surface.nodes.length / 3;
  const first = new Map<number, number>();
  const uses = new Map<number, number>();
  const rims = new Map<number, [number, number]>();
  for (let i = 0; i < t.length; ++i) {
    const a = t[i];
    const b = t[i % 3 === 2 ? i - 2 : i + 1];
    const key = Math.min(a, b) * count + Math.max(a, b);
    const label = surface.labels[Math.floor(i / 3)];
    const before = first.get(key);
    uses.set(key, (uses.get(key) ?? 0) + 1);
    if (before === undefined) {
      first.set(key, label);
      rims.set(key, [a, b]);
    } else if (before === label && uses.get(key) === 2) {
      rims.delete(key);
    }
  }
  return Uint32Array.from([...rims.values()].flat());
}

/** Mean of a surface's nodes, or null when it has none. */
export function centreOf(
  surface: Surface,
  names: string[],
): [number, number, number] | null {
  const wanted = new Set(names.map((name) => surface.names.indexOf(name)));
  const sum = [0, 0, 0];
  let n = 0;
  for (let i = 0; i < surface.triangles.length; ++i) {
    if (wanted.has(surface.labels[Math.floor(i / 3)])) {
      const id = surface.triangles[i];
      for (let c = 0; c < 3; ++c) {
        sum[c] += surface.nodes[3 * id + c];
      }
      ++n;
    }
  }
  return n > 0 ? [sum[0] / n, sum[1] / n, sum[2] / n] : null;
}

export interface Box {
  centre: [number, number, number];
  low: [number, number, number];
  high: [number, number, number];
  radius: number;
}

export function boxOf(nodes: Float32Array): Box {
  const low: [number, number, number] = [Infinity, Infinity, Infinity];
  const high: [number, number, number] = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < nodes.length; ++i) {
    const c = i % 3;
    low[c] = Math.min(low[c], nodes[i]);
    high[c] = Math.max(high[c], nodes[i]);
  }
  const half = low.map((v, c) => 0.5 * (high[c] - v));
  return {
    centre: low.map((v, c) => v + half[c]) as [number, number, number],
    low,
    high,
    radius: Math.max(Math.hypot(...half), 1e-12),
  };
}

/** Where a plane crosses the elements. */
export interface Section {
  nodes: Float32Array;
  displacement: Float32Array;
  value: Float32Array;
  /** Pairs of nodes: outlines of the cut elements. */
  edges: Uint32Array;
  triangles: Uint32Array;
}

const TET_EDGES = [
  [0, 1],
  [0, 2],
  [0, 3],
  [1, 2],
  [1, 3],
  [2, 3],
];
/** Crossed edges of a tetrahedron in order around the cut, by the corners
 * (bits) that lie beyond the plane; others are the mirror of these. */
const CUTS: Record<number, number[]> = {
  1: [0, 1, 2],
  2: [0, 4, 3],
  4: [1, 3, 5],
  8: [2, 5, 4],
  3: [1, 2, 4, 3],
  5: [0, 2, 5, 3],
  9: [0, 1, 5, 4],
};

/** Linear in each element: corners' values along the crossed edges. */
export function sectionOf(
  mesh: Mesh,
  normal: [number, number, number],
  level: number,
  values: Float32Array | undefined,
): Section {
  const nodes: number[] = [];
  const displacement: number[] = [];
  const value: number[] = [];
  const edges: number[] = [];
  const triangles: number[] = [];
  const tets = mesh.tets ?? new Uint32Array();
  const count = mesh.nodes.length / 3;
  const distance = new Float32Array(count);
  for (let i = 0; i < count; ++i) {
    distance[i] =
      mesh.nodes[3 * i] * normal[0] +
      mesh.nodes[3 * i + 1] * normal[1] +
      mesh.nodes[3 * i + 2] * normal[2] -
      level;
  }
  const u = mesh.displacement;
  for (let e = 0; e < tets.length; e += 4) {
    let beyond = 0;
    for (let k = 0; k < 4; ++k) {
      beyond |= distance[tets[e + k]] > 0 ? 1 << k : 0;
    }
    const cut = CUTS[beyond] ?? CUTS[15 - beyond];
    if (cut === undefined || beyond === 0 || beyond === 15) {
      continue;
    }
    const first = nodes.length / 3;
    for (const edge of cut) {
      const a = tets[e + TET_EDGES[edge][0]];
      const b = tets[e + TET_EDGES[edge][1]];
      const t = distance[a] / (distance[a] - distance[b]);
      for (let c = 0; c < 3; ++c) {
        nodes.push(mix(mesh.nodes[3 * a + c], mesh.nodes[3 * b + c], t));
        displacement.push(u ? mix(u[3 * a + c], u[3 * b + c], t) : 0);
      }
      value.push(values ? mix(values[a], values[b], t) : NaN);
    }
    for (let k = 0; k < cut.length; ++k) {
      edges.push(first + k, first + ((k + 1) % cut.length));
      if (k > 1) {
        triangles.push(first, first + k - 1, first + k);
      }
    }
  }
  return {
    nodes: Float32Array.from(nodes),
    displacement: Float32Array.from(displacement),
    value: Float32Array.from(value),
    edges: Uint32Array.from(edges),
    triangles: Uint32Array.from(triangles),
  };
}

function mix(a: number, b: number, t: number): number {
  return a + (b - a) * t;
}
