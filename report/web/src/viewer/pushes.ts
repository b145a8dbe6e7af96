import { unpackReals, type PageData } from "../data";

/** A way to change a response by moving curves. */
export interface Push {
  label: string;
  /** Per curve: points and their motion, in the case's length. */
  curves: { points: Float32Array; motion: Float32Array }[];
}

/** What lowers and what raises each response most for a step of the design
 * variables, each measured in its range: their gradient, on the curves. */
export function pushesOf(data: PageData): Push[] {
  const curves = data.curves ?? [];
  const variables = data.case?.design ?? [];
  const gradients = data.gradients;
  const pushes: Push[] = [];
  if (!gradients) {
    return pushes;
  }
  const unpacked = curves.map((curve) => ({
    points: unpackReals(curve.points),
    motion: new Map(
      Object.entries(curve.motion).map(([name, m]) => [name, unpackReals(m)]),
    ),
  }));
  data.case!.responses.forEach((response, r) => {
    const row = gradients.rows[r] ?? [];
    if (row.every((g) => g === null || g === 0)) {
      return;
    }
    for (const [verb, sign] of [
      ["cut", -1],
      ["raise", 1],
    ] as const) {
      const moved = unpacked.map((curve) => {
        const motion = new Float32Array(curve.points.length);
        variables.forEach((variable, k) => {
          const by = curve.motion.get(variable.name);
          const range = (variable.upper ?? 1) - (variable.lower ?? 0);
          const step = sign * (row[k] ?? 0) * range * range;
          by?.forEach((value, i) => {
            motion[i] += step * value;
          });
        });
        return { points: curve.points, motion };
      });
      if (moved.some((curve) => curve.motion.some((v) => v !== 0))) {
        pushes.push({ label: `${verb} ${response.name}`, curves: moved });
      }
    }
  });
  return pushes;
}
