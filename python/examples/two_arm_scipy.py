# %% [markdown]
# # A bracket and a strut, driven by SciPy
#
# Meniscus has optimizers of its own (`meniscus run`). Here SciPy drives: each
# design it asks for is settled, meshed and solved, and each derivative is the
# exact one through film, mesh and elasticity.
#
# Run it as a script, or cell by cell in an editor that knows `# %%`.

# %%
import pathlib
import tomllib

import numpy as np
from scipy import optimize

import meniscus

CASES = pathlib.Path(__file__).resolve().parents[2] / "cases"

# %% [markdown]
# ## Where must the foot stand?
#
# The bracket of `cases/two_arm` carries 40 kN on its left arm and 60 kN on its
# right one. Where must its foot stand so that both arms deflect alike? Elements
# of 20 mm will do for a look; the case itself has 8 mm.

# %%
bracket = meniscus.read_case(
    CASES / "two_arm" / "case.toml",
    {"resolution.fea": 20.0, "resolution.film": 10.0})
for variable in bracket.design:
    print(f"{variable.name}: {variable.initial:g} in [{variable.lower:g}, "
          f"{variable.upper:g}] {bracket.units.length}")
for response in bracket.responses:
    print(f"{response.name} [{response.unit}]")

# %% [markdown]
# The model is frozen once. From then on an evaluation depends on the design
# alone, so differences between designs are those of the part and not of its
# mesh. SciPy asks for the value and for the derivative of the same design one
# after the other; `Remember` computes it once.

# %%
model = meniscus.Model(bracket)
at = meniscus.Remember(model)
PADS = ["left_deflection", "right_deflection"]


def mismatch(design):
    """Relative difference of the deflections, as [study] measures it."""
    left, right = (at(design)[name] for name in PADS)
    return np.array([2 * (left - right) / (left + right)])


def mismatch_slope(design):
    left, right = (at(design)[name] for name in PADS)
    d_left, d_right = at(design).gradient(PADS)
    return np.array([4 * (right * d_left - left * d_right)
                     / (left + right) ** 2])


match = optimize.least_squares(
    mismatch, bracket.initial_design, jac=mismatch_slope,
    bounds=(bracket.lower_bounds, bracket.upper_bounds),
    xtol=1e-12, ftol=None, gtol=None)
foot = match.x[0]
print(f"\nsupport_x = {foot:.6f} {bracket.units.length} after {at.count} "
      f"designs, mismatch {abs(match.fun[0]):.1e}")
for name in PADS:
    print(f"  {name:17} {model.evaluate()[name]:.6f} at the start, "
          f"{at(match.x)[name]:.6f} {bracket.units.length}")

# %% [markdown]
# The fields behind the answer are NumPy arrays, not copied: displacements and
# stresses at the nodes of ten-node tetrahedra.

# %%
solution = at(match.x).solution
mesh = at(match.x).mesh
stress = solution.stress("service")
moved = np.linalg.norm(solution.displacement("service"), axis=1)
print(f"\n{len(mesh.elements)} elements; largest displacement "
      f"{moved.max():.4f} {bracket.units.length} at "
      f"{mesh.nodes[moved.argmax()].round(1)}, von Mises stress "
      f"{stress.max_von_mises:.1f} {bracket.units.pressure}")

# %% [markdown]
# ## How light can a strut be?
#
# `cases/strut_family` sizes thirty struts. The one in its case file alone, with
# larger elements: a case file is a dict, and a dict is a case.

# %%
tree = tomllib.loads((CASES / "strut_family" / "case.toml").read_text())
tree["resolution"] = {"fea": 9.0, "film": 4.5}
tree["study"] = {
    "kind": "minimize", "objective": "mass", "method": "slsqp",
    "constraints": [{"response": "deflection", "max": 0.1},  # mm
                    {"response": "margin", "min": 2e-4}]}  # N/mm3
strut = meniscus.make_case(tree)
strut_model = meniscus.Model(strut)
strut_at = meniscus.Remember(strut_model)

# %% [markdown]
# SLSQP likes numbers near one: designs between 0 and 1 from bound to bound,
# the mass over the first one's, constraints over their bounds. Its first step
# goes to a corner of the bounds, where the film pinches. A failed design is an
# answer: infinite mass, and SLSQP shortens its step.

# %%
low, high = strut.lower_bounds, strut.upper_bounds
start = strut_model.evaluate()


def evaluate(z):
    return strut_at(low + z * (high - low))


def slope(name, scale):
    return lambda z: evaluate(z).gradient(name) * (high - low) / scale


def mass(z):
    return evaluate(z)["mass"] / start["mass"] if evaluate(z).ok else np.inf


def bounded(name, bound, sign):
    """sign * (bound - response) / bound >= 0, for SciPy."""
    def room(z):
        return sign * (1 - evaluate(z)[name] / bound) if evaluate(z).ok else -1

    return {"type": "ineq", "fun": room,
            "jac": lambda z: -sign * slope(name, bound)(z)}


lightest = optimize.minimize(
    mass, (strut.initial_design - low) / (high - low),
    jac=slope("mass", start["mass"]), method="SLSQP", bounds=[(0, 1)] * len(low),
    constraints=[bounded("deflection", 0.1, +1), bounded("margin", 2e-4, -1)],
    options={"ftol": 1e-10, "maxiter": 60})
best = evaluate(lightest.x)

# %%
print(f"\n{lightest.message} after {strut_at.count} designs")
print(f"{'':12}{'start':>12}{'lightest':>12}")
for k, variable in enumerate(strut.design):
    print(f"{variable.name:12}{variable.initial:12.5g}{best.design[k]:12.5g}")
for response in strut.responses:
    print(f"{response.name:12}{start[response.name]:12.5g}"
          f"{best[response.name]:12.5g} {response.unit}")
