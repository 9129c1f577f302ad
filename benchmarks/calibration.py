"""Do the bands of `conveyor calibrate` hold what they say? Conveyors with known factors, measured with noise.

    python benchmarks/calibration.py [CONVEYORS] [DRAWS]      # 20 and 5

Every conveyor is an example spec of another length and lift, its factors drawn evenly (indentation and flexure 0.7 to
2, idler rotation 0.6 to 1.6); runs empty, at half and full load, at 0, 15 and 30 degC; power with 2 % noise, DRAWS
times. Counted is how often the band of a factor holds the truth; of a factor for several forces the truth is the mean
of theirs as the runs weigh them: what least squares makes of runs without noise. Beside it the power at full load and
15 degC against its truth. The error of a count is binomial: sqrt(p (1 - p)/n).
"""

from __future__ import annotations

import math
import sys
from collections import defaultdict
from pathlib import Path
from time import perf_counter

import numpy as np

import conveyor
from conveyor.calculated_conveyor import CalculatedConveyor, Variant
from conveyor.errors import InputError
from conveyor.models import Calibration, Conveyor, MeasuredRun
from conveyor.models.variants import with_runs
from conveyor.pipeline import calculate_many
from conveyor.units import from_si

SPECS = Path(__file__).resolve().parents[1] / "examples" / "specs"
NOISE = 0.02
STATES = [(flow, warmth) for flow in (0.0, 0.5, 1.0) for warmth in (0, 15, 30)]
AT = STATES.index((1.0, 15))


def drawn(rng: np.random.Generator) -> Conveyor:
    """An overland or in-plant conveyor of another length and lift."""
    spec = conveyor.load(SPECS / str(rng.choice(["overland.yaml", "in_plant_us.yaml"])))
    long, high = rng.uniform(0.6, 1.5), rng.uniform(0.0, 0.6)
    sections = [
        section.replace(length=section.length * long, lift=from_si(section.rise * high, "length"), slope=None)
        for section in spec.route.sections
    ]
    return spec.replace(route=spec.route.replace(sections=sections), calculation=spec.calculation.replace(rtol=1e-3))


def powers(spec: Conveyor, runs: list[MeasuredRun]) -> list[CalculatedConveyor]:
    """The runs, calculated."""
    found = calculate_many([Variant(one) for one in with_runs(spec, runs)])
    for one in found:
        if not isinstance(one, CalculatedConveyor):
            raise one
    return found


def main(conveyors: int, draws: int) -> None:
    """Print how many bands hold the truth."""
    rng, begun = np.random.default_rng(13), perf_counter()
    held: dict[str, list[bool]] = defaultdict(list)
    off, refused = [], 0
    for _ in range(conveyors):
        spec = drawn(rng)
        truth = Calibration(
            indentation=rng.uniform(0.7, 2.0),
            idler_rotation=rng.uniform(0.6, 1.6),
            flexure=rng.uniform(0.7, 2.0),
        )
        if shares(spec):
            truth = truth.replace(flexure=1.0)
        runs = [
            MeasuredRun(power="1 kW", at="motor shaft", flow=spec.material.flow * flow, temperature=f"{warmth} degC")
            for flow, warmth in STATES
        ]
        made = powers(spec.replace(calculation=spec.calculation.replace(calibration=truth)), runs)
        plain = [{force.key: force.total for force in one.balance.along} for one in powers(spec, runs)]
        weights = np.array([one.balance.power.motor for one in made]) ** -2.0
        for _ in range(draws):
            noise = 1.0 + NOISE * rng.standard_normal(len(runs))
            noisy = [
                run.replace(power=from_si(one.balance.power.motor * factor, "power"))
                for run, one, factor in zip(runs, made, noise.tolist(), strict=True)
            ]
            try:
                found = conveyor.calibrate(spec, noisy)
            except InputError:
                refused += 1
                continue
            groups = [factor.forces for factor in found.factors]
            for factor, true in zip(found.factors, means(groups, plain, weights, truth), strict=True):
                held[factor.name].append(factor.low <= true <= factor.high)
            off.append(found.runs[AT].after / made[AT].balance.power.motor - 1.0)
    every = [one for each in held.values() for one in each]
    for name, each in {**held, "all bands": every}.items():
        share = sum(each) / len(each)
        print(f"{name:40} {share:6.1%} of {len(each):4} bands hold, +-{math.sqrt(share * (1 - share) / len(each)):.1%}")
    spread, mean = np.std(off), np.mean(off)
    print(f"power at full load, 15 degC: off by {spread:.2%} (one standard deviation), {mean:+.2%} in the mean")
    print(f"{refused} of {conveyors * draws} refused; {perf_counter() - begun:.0f} s")


def means(
    groups: list[tuple[str, ...]], forces: list[dict[str, float]], weights: np.ndarray, truth: Calibration
) -> list[float]:
    """Truth of every group: its mean as the runs weigh it, P = sum of J_i theta_i, A = (X'WX)^-1 X'W."""
    columns = np.array([[sum(one[name] for name in group) for group in groups] for one in forces])
    solved = np.linalg.solve(columns.T @ (weights[:, None] * columns), columns.T * weights)
    found = []
    for k, group in enumerate(groups):
        moved = {name: float(solved[k] @ np.array([one[name] for one in forces])) for name in group}
        found.append(sum(truth.factors[name] * share for name, share in moved.items()))
    return found


def shares(spec: Conveyor) -> bool:
    """Whether flexure is a share of the main resistance, and follows the other factors."""
    (found,) = powers(spec, [MeasuredRun(power="1 kW", at="motor shaft", flow=spec.material.flow)])
    return found.rubber_free.flexure is None


if __name__ == "__main__":
    given = [int(word) for word in sys.argv[1:]]
    main(*(given + [20, 5][len(given) :]))
