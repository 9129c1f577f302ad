"""What a comparison's indentation is off by: random compounds, temperatures and speeds beside contacts of 1e-7.

    python benchmarks/compare_error.py [COMPARISONS] [SEED]

Comparisons share curves, and read working strains among three speeds; the others find every strain at its own speed.
"""

from __future__ import annotations

import sys

import numpy as np
from compare import SPEC, varied

import conveyor
from conveyor.calculated_conveyor import CalculatedConveyor, Variant
from conveyor.models import Conveyor
from conveyor.models.variants import crossed_settings, with_compound
from conveyor.pipeline import calculate_many
from conveyor.units import quantity


def main(comparisons: int, seed: int) -> None:
    rng, compounds, line = np.random.default_rng(seed), varied(40), conveyor.load(SPEC)
    off = []
    for _ in range(comparisons):
        compound = compounds[rng.integers(len(compounds))]
        slowest = rng.uniform(4.4, 5.0)
        temperatures = [f"{t:.2f} degC" for t in rng.uniform(-30.0, 40.0, 2)]
        drawn = np.linspace(slowest, slowest * rng.uniform(1.2, 1.95), rng.integers(5, 12))
        speeds = [f"{v:.4f} m/s" for v in drawn]
        found = conveyor.compare_compounds(line, [compound], temperatures=temperatures, speeds=speeds)
        settings = crossed_settings(
            with_compound(line, compound, "bottom"),
            [quantity(t, "temperature") for t in temperatures],
            [quantity(v, "speed") for v in speeds],
        )
        going = [(one.conveyor, one.temperature) for one in settings if isinstance(one.conveyor, Conveyor)]
        alone = calculate_many([Variant(*one) for one in going], 1e-7)
        if len(alone) == len(found.scenes):
            off += [
                (abs(scene.indentation / one.balance.forces.indentation - 1.0), scene.error)
                for scene, one in zip(found.scenes, alone, strict=True)
                if isinstance(one, CalculatedConveyor)
            ]
    error, claimed = np.array(off).T
    print(
        f"{error.size} scenes: off by {np.median(error):.1e} in the median, {np.quantile(error, 0.99):.1e} in 99 %, "
        f"{error.max():.1e} at most; claimed {claimed.max():.1e} at most; {np.sum(error > claimed)} beyond their claim"
    )


if __name__ == "__main__":
    given = [int(one) for one in sys.argv[1:]]
    main(*(given + [30, 1][len(given) :]))
