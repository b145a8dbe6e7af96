import type { Units } from "../data";

export interface FieldInfo {
  key: string;
  label: string;
  unit: string;
  on: "part" | "film";
  /** What it is, in a sentence. */
  about: string;
}

export function fieldInfos(units: Units): FieldInfo[] {
  const energy = `${units.force}\u00b7${units.length}/${units.length}\u00b3`;
  return [
    {
      key: "von_mises",
      label: "von Mises stress",
      unit: units.pressure,
      on: "part",
      about: "Compare it with the material's yield strength.",
    },
    {
      key: "displacement",
      label: "displacement",
      unit: units.length,
      on: "part",
      about: "How far each point moves under the loads.",
    },
    {
      key: "energy_density",
      label: "strain energy density",
      unit: energy,
      on: "part",
      about: "Where the part works: elastic energy per volume.",
    },
    {
      key: "stress_error",
      label: "estimated stress error",
      unit: units.pressure,
      on: "part",
      about: "How far stresses may be off because elements have a size.",
    },
    {
      key: "mean_curvature",
      label: "film mean curvature",
      unit: `1/${units.length}`,
      on: "film",
      about:
        "Half the sum of the principal curvatures, positive for a sphere; " +
        "even where tension and pressure alone shape the film.",
    },
  ];
}

/** Stress of one load case of several: "von_mises:NAME". */
export function caseFieldInfos(keys: string[], units: Units): FieldInfo[] {
  const prefix = "von_mises:";
  return keys
    .filter((key) => key.startsWith(prefix))
    .map((key) => ({
      key,
      label: `von Mises stress, ${key.slice(prefix.length).replace(/_/g, " ")}`,
      unit: units.pressure,
      on: "part",
      about: "Of this load case; loads and deflection are drawn of the worst.",
    }));
}

/** Least and largest finite value of all. */
export function rangeOf(fields: (Float32Array | undefined)[]): [number, number] {
  let low = Infinity;
  let high = -Infinity;
  for (const values of fields) {
    for (const value of values ?? []) {
      if (Number.isFinite(value)) {
        low = Math.min(low, value);
        high = Math.max(high, value);
      }
    }
  }
  return low <= high ? [low, high] : [0, 1];
}

/** The range without the outermost hundredth at either end. */
export function middleRange(
  fields: (Float32Array | undefined)[],
): [number, number] {
  const all: number[] = [];
  for (const values of fields) {
    for (const value of values ?? []) {
      if (Number.isFinite(value)) {
        all.push(value);
      }
    }
  }
  if (all.length === 0) {
    return [0, 1];
  }
  all.sort((a, b) => a - b);
  return [
    all[Math.floor(0.01 * (all.length - 1))],
    all[Math.ceil(0.99 * (all.length - 1))],
  ];
}
