/** What the program writes into the page (report/page/report_page.cpp). */

/** Whole numbers from 0, little-endian in base64. */
export interface PackedIds {
  type: "u8" | "u16" | "u32";
  data: string;
}

/** Numbers in 65535 even steps per component; level 65535 is no number. */
export interface PackedReals {
  type: "q16";
  components: number;
  offset: number[];
  step: number[];
  data: string;
}

export interface PackedSurface {
  nodes: PackedReals;
  triangles: PackedIds;
  labels: PackedIds;
  names: string[];
}

export interface PackedMesh extends PackedSurface {
  four_a_face: boolean;
  load_case: string;
  tets?: PackedIds;
  displacement?: PackedReals;
  fields: Record<string, PackedReals>;
}

export interface PackedFilm extends PackedSurface {
  solid: boolean[];
  fields: Record<string, PackedReals>;
}

export interface PartData {
  name: string;
  mesh: PackedMesh;
  note?: string;
  link?: string;
}

export interface Frame {
  evaluation: number;
  /** In the list of all that were stored. */
  place: number;
  nodes: PackedReals;
  /** Triangles; none: those of the frame before. */
  surface?: Omit<PackedSurface, "nodes">;
  curves?: PackedReals[];
}

export interface Frames {
  stored: number;
  frames: Frame[];
}

export interface Findings {
  nodes: PackedReals;
  triangles: PackedIds;
  places: number[];
  messages: string[];
  surface?: PackedSurface;
}

export interface CurveData {
  name: string;
  /** Around a closed curve; with `pieces` two ends of each piece. */
  points: PackedReals;
  pieces?: boolean;
  motion: Record<string, PackedReals>;
}

export interface LoadItem {
  /** Surfaces that carry it together. */
  on: string[];
  kind: "force" | "moment" | "pressure" | "traction" | "support" | "spring";
  vector: [number, number, number] | null;
  /** Of forces and moments through a point. */
  at: [number, number, number] | null;
}

export interface LoadCase {
  name: string;
  unit: string;
  items: LoadItem[];
}

export interface Gradients {
  evaluation: number;
  at_answer: boolean;
  rows: (number | null)[][];
}

export interface DesignVariable {
  name: string;
  /** In the case's units; empty where the case does not say. */
  unit: string;
  initial: number;
  lower: number | null;
  upper: number | null;
}

export interface ResponseData {
  name: string;
  unit: string;
  on: string;
  load_case: string;
}

export interface Bound {
  response: string;
  min: number | null;
  max: number | null;
}

export interface CaseData {
  path: string;
  text: string;
  overrides: string[];
  hash: string;
  design: DesignVariable[];
  /** Those that people know by one name, from place `first` on; of older pages none. */
  vectors?: { name: string; shape: number[]; first: number }[];
  responses: ResponseData[];
  parameter_units: Record<string, string>;
  study: {
    kind: string;
    method: string;
    equal: string[];
    targets: Record<string, number>;
    tolerance: number;
    objective: string | null;
    second: string | null;
    constraints: Bound[];
  };
}

export interface Units {
  system: string;
  length: string;
  force: string;
  pressure: string;
  mass: string;
}

export type Numbers = Record<string, number | null>;

/** One number, or those of a vector of design variables in arrays of its shape. */
export type Nested = number | null | Nested[];
/** Design variables and parameters by name. */
export type Inputs = Record<string, Nested>;

export interface Distribution {
  mean: number;
  coefficient_of_variation: number;
  gini: number;
  p05: number;
  p50: number;
  p95: number;
  p95_over_p50: number;
  peak: number;
  peak_over_mean: number;
  histogram: number[];
}

export interface StressFigures {
  max_von_mises: number | null;
  position?: number[];
  /** Of a load from any direction: one of those that it is made of. */
  unit_load?: boolean;
  /** Of one that shows such a load: the worst, a unit vector. */
  direction?: number[];
  safety_factor?: {
    smallest: number | null;
    von_mises: number;
    material: string;
  };
  von_mises?: Distribution;
  energy_density?: Distribution;
}

export interface NormPeak {
  norm: number | null;
  of?: "mean" | "bound"; // a bound is a ratio to what is allowed
  load_case: string;
  peak: number | null;
  bound?: number | null;
  peak_within_bound?: boolean;
}

export interface MemberResult {
  name: string;
  folder: string;
  parent: string;
  status: string;
  message: string;
  parameters: Inputs;
  design: Inputs;
  objective: number | null;
  constraints: Constraints;
  responses: Numbers;
  evaluations: number;
  seconds: number;
}

export type Constraints = Record<
  string,
  { value: number | null; bound: number | null; satisfied: boolean }
>;

/** A bound that a minimum stands at. */
export interface BindingBound {
  name: string;
  of: "constraint" | "variable";
  side: "lower" | "upper" | "both";
  bound: number;
  /** What the objective does where the bound gives way by `step`. */
  step: number;
  change: number | null;
}

/** result.json (docs/results.md), as far as the page looks at it. */
export interface Result {
  case: string;
  case_hash: string;
  program_version: string;
  units?: Units;
  status: string;
  message: string;
  parameters?: Inputs;
  parameter_errors?: Inputs;
  objective?: number | null;
  constraints?: Constraints;
  multipliers?: { residual: number | null; binding: BindingBound[] };
  refrozen?: { evaluation: number; reason: string }[];
  topology?: { kind: string; designs: number; evaluation: number; message: string }[];
  responses?: Numbers;
  response_errors?: Numbers;
  start?: { parameters: Inputs; responses: Numbers };
  evaluations?: number;
  failed_evaluations?: number;
  gradient_evaluations?: number;
  film?: {
    vertices: number;
    facets: number;
    energy: number;
    area: number;
    residual: number;
    residual_bound: number;
    min_eigenvalue: number | null;
    index: number;
    smallest_neck: number | null;
    neck_position?: (number | null)[];
    verdict: string;
    bodies: Record<string, { volume: number; pressure: number }>;
  };
  tet?: {
    nodes: number;
    elements: number;
    min_dihedral_deg: number;
    max_dihedral_deg: number;
  };
  fea?: {
    dofs: number;
    solver: string;
    iterations: number;
    residual: number;
    strain_energy: number;
    reaction_imbalance: number;
  };
  element_errors?: { energy: number };
  stress?: Record<string, StressFigures>;
  /** Nearest to yield; of older results none. */
  worst_load_case?: string;
  /** Means over the volume beside the peaks they are bounded for. */
  norm_peaks?: Record<string, NormPeak>;
  /** Of loads from any direction: the worst for each response, a unit vector. */
  worst_directions?: Record<string, { load_case: string; direction: (number | null)[] }>;
  envelopes?: Record<string, { most?: string; least?: string; value: number | null }>;
  buckling?: Record<
    string,
    {
      verdict?: string;
      above?: number | null;
      factors?: (number | null)[];
      errors?: (number | null)[];
      stress?: { matters: boolean }[];
      none_below?: number | null;
    }
  >;
  natural_frequencies?: { values: number[]; supports_of?: string };
  sweep?: {
    designs: number;
    looked_at: number;
    failed: number;
    responses: Record<
      string,
      {
        least: number | null;
        largest: number | null;
        mean: number | null;
        least_at?: Inputs | null;
        largest_at?: Inputs | null;
      }
    >;
  };
  tolerance?: {
    deviations: Inputs;
    samples: number;
    failed: number;
    responses: Record<
      string,
      {
        deviation?: number | null;
        shares?: Inputs | null;
        sampled?: {
          mean: number | null;
          deviation: number | null;
          mean_error: number | null;
          deviation_error: number | null;
          least: number | null;
          largest: number | null;
        } | null;
      }
    >;
  };
  front?: {
    objectives: string[];
    points: (Record<string, unknown> & { parameters: Inputs; end: string })[];
  };
  members?: MemberResult[];
  ledger?: unknown;
  seconds?: Record<string, number>;
  warnings?: string[];
}

export interface ComparedPart {
  name: string;
  parts: number;
  volume: number;
  mass: number;
  elements: number;
  exclusion?: { volume_share: number };
  load_cases: Record<
    string,
    {
      stiffness: number | null;
      stiffness_per_mass: number | null;
      work: number;
      max_von_mises: number;
      coefficient_of_variation: number;
      gini: number;
    }
  >;
}

export interface Comparison {
  program_version: string;
  units: Units;
  parts: ComparedPart[];
}

export interface PageData {
  format: number;
  kind: "run" | "family" | "comparison" | "film";
  folder: string;
  versions: string;
  parts: PartData[];
  result?: Result;
  comparison?: Comparison;
  case?: CaseData;
  history?: string;
  film?: PackedFilm;
  frames?: Frames | null;
  findings?: Findings;
  curves?: CurveData[];
  loads?: LoadCase[];
  gradients?: Gradients | null;
  notes?: string[];
  /** Of a film alone: what its frames show, and other figures. */
  captions?: string[];
  quantities?: Numbers;
}

function bytes(text: string): Uint8Array {
  const raw = atob(text);
  const result = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) {
    result[i] = raw.charCodeAt(i);
  }
  return result;
}

export function unpackIds(packed: PackedIds): Uint32Array {
  const raw = bytes(packed.data);
  const size = { u8: 1, u16: 2, u32: 4 }[packed.type];
  const view = new DataView(raw.buffer);
  const result = new Uint32Array(raw.length / size);
  for (let i = 0; i < result.length; ++i) {
    result[i] =
      size === 1
        ? raw[i]
        : size === 2
          ? view.getUint16(2 * i, true)
          : view.getUint32(4 * i, true);
  }
  return result;
}

export function unpackReals(packed: PackedReals): Float32Array {
  const raw = bytes(packed.data);
  const view = new DataView(raw.buffer);
  const result = new Float32Array(raw.length / 2);
  const width = packed.components;
  for (let i = 0; i < result.length; ++i) {
    const level = view.getUint16(2 * i, true);
    result[i] =
      level === 65535
        ? NaN
        : packed.offset[i % width] + level * packed.step[i % width];
  }
  return result;
}

/** The page's data; null in a template that holds none. */
export function pageData(): PageData | null {
  const text = document.getElementById("meniscus-data")?.textContent ?? "null";
  const data = JSON.parse(text) as PageData | string | null;
  return data !== null && typeof data === "object" ? data : null;
}
