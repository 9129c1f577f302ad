"""Tutorial in cells, from a spec to its report; `06_tutorial.ipynb` holds the same cells."""

# %% [markdown]
# # Tutorial: a conveyor from its spec to its report
#
# Every cell builds on those before it. The same cells are in `06_tutorial.ipynb`; run this file from a checkout with
# `python examples/06_tutorial.py`, or cell by cell in an editor that knows `# %%`. It takes a few seconds.

# %%
from pathlib import Path

import numpy as np

import conveyor
from conveyor import shelf
from conveyor.units import si, text

specs = next(folder for folder in (Path("examples/specs"), Path("specs")) if folder.is_dir())

# %% [markdown]
# ## Load
#
# A spec is data with units. `load` reads and checks it; what it refuses, it refuses all at once, each with line and
# column. The fields are quantities as they were written; `si` gives the number in SI units.

# %%
line = conveyor.load(specs / "overland.yaml")
print(line.name, "-", text(line.belt.width), "at", text(line.belt.speed))
print(f"{line.route.length:.0f} m long, {line.route.rise:.1f} m up, {si(line.material.flow):.1f} kg/s")

# %% [markdown]
# ## Analyse
#
# One call. The result holds forces, tensions and power, and what they rest on: every default that was used, every limit
# that is strained.

# %%
result = conveyor.analyse(line)
power, forces = result.balance.power, result.balance.forces
print(f"motor {power.motor / 1e3:.1f} kW, effective tension {forces.total / 1e3:.1f} kN")
print(f"indentation is {forces.indentation / forces.main:.0%} of the main resistance")
print(f"f = {result.balance.friction_factor:.4f}; the classical estimate took {line.calculation.friction_factor}")
for remark in result.assumptions[:3]:
    print("-", remark)

# %% [markdown]
# ## Tables
#
# Tables are pandas frames with the unit in the name of the column. Where does the force come from, and which section
# asks for most of it per metre?

# %%
result.resistances[["resistance", "kind", "force [N]"]].round(0)

# %%
carry = result.sections.query("strand == 'carry'").copy()
carry["indentation per metre [N/m]"] = carry["indentation [N]"] / carry["length [m]"]
carry[["section", "length [m]", "idler spacing [m]", "indentation per metre [N/m]"]].round(2)

# %% [markdown]
# ## Change something
#
# Models do not change; `replace` returns a checked copy. What would the standard cover cost, and what does a day at
# -20 °C?

# %%
cover = line.belt.bottom_cover.replace(compound=shelf.compound("standard-cover"))
standard = line.replace(belt=line.belt.replace(bottom_cover=cover))
cold = line.replace(ambient=line.ambient.replace(temperature="-20 degC"))
for name, other in {"as given": line, "standard cover": standard, "at -20 degC": cold}.items():
    print(f"{name:>15}: {conveyor.analyse(other).balance.power.motor / 1e3:7.1f} kW")

# %% [markdown]
# ## Compare compounds
#
# Over temperature, because the better cover in summer may be the worse one in a cold start. The data of a compound may
# not reach as far as the rolls ask: `coverage` says so. The covers are constructed, at the level of a published
# rolling-resistance test; S100 is measured (tyre-type) without such a test, at the level of the theory: it is not
# better by what it seems to save.

# %%
comparison = conveyor.compare_compounds(
    line,
    ["standard-cover", "low-rolling-resistance-cover", "s100"],
    temperatures=[f"{celsius} degC" for celsius in range(-20, 41, 10)],
)
comparison.ranking[["compound", "mean motor power [kW]", "peak motor power [kW]", "at temperature [degC]"]].round(1)

# %% [markdown]
# ## Plot
#
# Figures are matplotlib figures: a notebook shows the last one of a cell, `savefig` writes it.

# %%
comparison.plots.power_against_temperature()

# %%
result.plots.resistances()

# %% [markdown]
# ## One contact
#
# Below all of this lies one roll under one cover. `RollContact` takes SI; the solver behind it is dimensionless
# (docs/method.md). The contact reaches farther, and presses harder, on the side that the belt comes from (positive x).

# %%
from conveyor.contact import solve
from conveyor.indentation import RollContact, to_problem

contact = RollContact(
    radius=0.0795,  # m
    spacing=1.5,  # m
    cover_thickness=0.005,  # m
    speed=5.0,  # m/s
    series=shelf.compound("s100").series(293.15),  # K
    poisson=0.5,
    support="confined",
)
line_load = 2000.0  # N/m
solution = solve(to_problem(contact, line_load))
print(f"friction {solution.friction:.4f}, estimated error {solution.error_estimate:.0e}")
print(f"contact from {solution.patches[0, 0]:.4f} to {solution.patches[0, 1]:.4f} radii about the axis")
print(f"indentation resistance {solution.friction * line_load:.2f} N per metre of width")

# %%
x = np.linspace(*solution.patches[0], 9)
print(np.round(solution.pressure(x) / solution.peak_pressure, 3))

# %% [markdown]
# ## Report
#
# A workbook for those who calculate on, a page to read and print.

# %%
folder = Path("tutorial")
folder.mkdir(exist_ok=True)
print(result.to_excel(folder / "overland.xlsx"))
print(result.to_html(folder / "overland.html"))
print(comparison.to_excel(folder / "compounds.xlsx"))

# %% [markdown]
# Read on: docs/programmer.md for the whole interface, docs/designer.md for the spec of your own conveyor,
# docs/rubber.md for your own rubber.
