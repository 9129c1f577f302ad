"""What does the better cover save? Three compounds on the overland conveyor, over temperature.

Run it as ``python examples/05_compounds.py [FOLDER]``; it prints the ranking and, with a folder, draws the figures of
docs/rubber.md into it.
"""

from __future__ import annotations

import sys
from pathlib import Path

import conveyor
from conveyor.fitting import summary
from conveyor.fitting.fitted_compound import Request, fit_file
from conveyor.report import plots

ROOT = Path(__file__).resolve().parent.parent
NAMES = ["standard-cover", "low-rolling-resistance-cover", "s100"]
TEMPERATURES = [f"{celsius} degC" for celsius in range(-25, 41, 5)]


def draw(comparison: conveyor.Comparison, result: conveyor.Analysis, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    plots.save_figure(plots.power_over(comparison, "temperature"), folder / "compare_power.png")
    carry = result.rubber.set_index("strand").loc["carry"]
    band = (carry["excited from [Hz]"], carry["excited to [Hz]"])
    figure = plots.loss_tangents(comparison.compounds, 293.15, {"90 % loss band of the carry rolls": band})
    plots.save_figure(figure, folder / "tan_delta.png")
    s120 = fit_file(
        ROOT / "materials" / "s120.dma.csv",
        Request("S120", shift=ROOT / "materials" / "s120.shift.csv", vertical=True),
    )
    plots.save_figure(summary.band_figure(s120), folder / "rubber_s120.png")


def main(folder: Path | None) -> None:
    line = conveyor.load(ROOT / "examples" / "specs" / "overland.yaml")
    comparison = conveyor.compare_compounds(line, NAMES, temperatures=TEMPERATURES)
    shown = ["compound", "mean motor power [kW]", "peak motor power [kW]", "at temperature [degC]"]
    print(comparison.ranking[shown].round(1).to_string(index=False))
    if folder is not None:
        draw(comparison, conveyor.analyse(line), folder)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else None)
