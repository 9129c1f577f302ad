"""True errors of the peak tensions of starts and stops, beside what is told of them.

    python benchmarks/dynamics_error.py [CONVEYORS] [SEED]      # 44 and 2

Every scenario of the examples, and one of each of CONVEYORS drawn: 300 m to 10 km, level, up or down, drives at head,
tail and along the belt, brakes, starters, take-ups of every kind and place, loadings, friction. Each is followed to an
error of 1 % of the highest tension as `conveyor dynamics` does, and once more in cells a quarter as long: the true
error is how far highest and lowest tension are from those, over the highest. Printed are the errors above what is told.
"""

from __future__ import annotations

import os

os.environ["OMP_NUM_THREADS"] = "1"  # before numpy: BLAS reads it once
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

import conveyor
from conveyor.dynamics.simulation import prepare_setups, simulate_batch, simulate_to_error, standard_scenarios
from conveyor.errors import NoSolutionError, RangeError
from conveyor.models import Conveyor, Scenario
from conveyor.spec import from_data

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
CLOSER = 4
WORKERS = 2
EVEN = 1e-9  # what rounding leaves of an error


def examples() -> Iterator[tuple[str, Conveyor, tuple[Scenario, ...]]]:
    for path in [*sorted(EXAMPLES.glob("specs/*.yaml")), *sorted(EXAMPLES.glob("dynamics/*.yaml"))]:
        spec = conveyor.load(path)
        yield path.stem, spec, tuple(spec.scenarios or standard_scenarios(spec))


def drawn(rng: np.random.Generator, k: int) -> tuple[str, Conveyor, tuple[Scenario, ...]]:
    def one(*values: Any) -> Any:
        return values[rng.integers(len(values))]

    length, grade = 10.0 ** rng.uniform(2.5, 4.0), one(0.0, 0.0, 0.005, 0.03, 0.1, -0.01, -0.05)
    flow, speed, time = one(600.0, 1500.0, 2400.0), rng.uniform(3.0, 6.0), rng.uniform(5.0, 40.0)
    bulk, shares = flow / 3.6 / speed, rng.dirichlet(np.full(rng.integers(1, 5), 2.0))
    force = 9.81 * length * (0.02 * (bulk + 60.0) + bulk * abs(grade))

    def motors(share: float) -> str:
        return f"{1.6e-3 * share * force * speed:.0f} kW"

    unit = {
        "kind": one("gravity", "gravity", "fixed", "winch"),
        "position": one("drive", "tail", "head", "return"),
    }
    unit |= {"section": "s0"} if unit["position"] == "return" else {}
    if unit["kind"] == "gravity":
        unit["carriage_mass"] = f"{one(0, 2, 5)} t"
    elif unit["kind"] == "winch":
        unit |= one({}, {"winch_speed": "0.3 m/s", "winch_band": "5 %", "winch_run_up": "1 s"})
    kind = one("inverter", "inverter", "inverter", "direct", "soft starter", "fluid coupling", "star-delta")
    starter = {"kind": kind} | ({} if kind == "direct" else {"time": f"{time:.0f} s"})
    if kind == "inverter":
        starter["ramp"] = one("linear", "cosine", "S")
    other = one(None, None, {"position": "tail"}, {}, {"position": "carry", "section": "s0"})
    drive = {"wrap_angle": f"{one(200, 400)} deg", "friction": 0.35, "efficiency": "95 %", "starter": starter,
             "installed_power": motors(1.0 if other is None else 0.7)}  # fmt: skip
    drive |= one({}, {"reduced_mass": f"{rng.uniform(1.0, 20.0):.1f} t"})
    drive |= one({}, {"brake_force": f"{rng.uniform(0.1, 0.6) * force:.0f} N"})
    if other is not None:
        late = {"name": "other", "wrap_angle": "200 deg", "friction": 0.35, "installed_power": motors(0.3)}
        drive["further_drives"] = [other | late | {"starter": starter | {"delay": f"{one(0, 2, 8)} s"}}]
    roll = {"diameter": "159 mm", "rotating_mass": "6 kg", "drag": "1.6 N"}
    spec = from_data({
        "name": "drawn",
        "belt": {"width": "1200 mm", "speed": f"{speed:.2f} m/s", "mass": "30 kg/m^2",
                 "top_cover": {"thickness": "7 mm"}, "bottom_cover": {"thickness": "5 mm", "compound": "S100"},
                 "carcass": {"thickness": "7 mm"} | one({"kind": "steel cord", "strength": "2500 N/mm"},
                                                        {"kind": "EP", "strength": "1250 N/mm"})},
        "idlers": {
            "carry": {"rolls": 3, "spacing": one("1.2 m", "3 m"), "trough_angle": "35 deg",
                      "roll": roll | {"length": "465 mm"}},
            "return": {"rolls": 2, "spacing": one("3 m", "6 m"), "trough_angle": "10 deg",
                       "roll": roll | {"length": "670 mm"}},
        },
        "material": {"name": "ore", "density": "1600 kg/m^3", "flow": f"{flow} t/h", "surcharge_angle": "15 deg"},
        "route": {
            "sections": [{"name": f"s{i}", "length": f"{length * share:.1f} m",
                          "lift": f"{length * share * grade * rng.uniform(0.5, 1.5):.2f} m"}
                         for i, share in enumerate(shares.tolist())],
            "take_up": unit,
            "cleaners": [{"count": 2, "width": "1100 mm", "thickness": "8 mm"}],
        } | one({}, {"feeding": {"speed": "2 m/s", "skirt_length": "6 m", "skirt_width": "750 mm"}})
        | one({}, {"pulleys": [{"name": name, "position": name, "diameter": "1000 mm", "shaft_diameter": "200 mm",
                                "mass": "2.5 t"} for name in ("head", "tail")]}),
        "drive": drive, "ambient": {"temperature": "15 degC"},
    })  # fmt: skip
    off = [{"do": "power off"}]
    begins, does = one(
        ("at rest", [{"do": "start"}]), ("at rest", [{"do": "start"}]), ("running", off),
        ("running", [{"do": "ramp down"}] if kind == "inverter" else off),
        ("running", [*off, *([{"at": "1 s", "do": "brake"}] if "brake_force" in drive else [])]),
    )  # fmt: skip
    lasts = 8.0 + 0.006 * length + (5.0 if does[0]["do"] == "power off" else 1.3 * time)
    scenario = Scenario.from_data({
        "name": does[-1]["do"], "begins": begins, "loading": one("full", "full", "worst", "empty"), "events": does,
        "duration": f"{lasts:.0f} s", "friction": one("100 %", "100 %", "60 %"),
    })  # fmt: skip
    return f"drawn {k}, take-up {unit['kind']} at {unit['position']}", spec, (scenario,)


def measured(
    case: tuple[str, Conveyor, tuple[Scenario, ...]],
) -> tuple[list[tuple[str, float, float]], list[str]]:
    """Name, error told and true error of every scenario; those refused."""
    name, spec, scenarios = case
    try:
        setups, _ = prepare_setups(spec, scenarios)
        followed, refused = simulate_to_error(setups)
    except (NoSolutionError, RangeError) as error:
        return [], [f"{name}: {error}"]
    found = []
    steps = {one.record.step for one in followed}
    for step in sorted(steps):  # those of one length of cells side by side
        told = [one for one in followed if one.record.step == step]
        for one, true in zip(told, simulate_batch([one.setup for one in told], step / CLOSER), strict=True):
            off = max(abs(true.highest - one.highest), abs(true.lowest - one.lowest)) / true.highest
            found.append((f"{name}: {one.name}", one.error or 0.0, off))
    return found, [f"{name}: {one.scenario}: {one.reason.text()}" for one in refused]


def main(count: int, seed: int) -> None:
    """Print errors above what is told, and their count."""
    rng, begun = np.random.default_rng(seed), perf_counter()
    cases = [*examples(), *(drawn(rng, k) for k in range(count))]
    errors: list[tuple[str, float, float]] = []
    with ProcessPoolExecutor(WORKERS) as pool:
        for found, refused in pool.map(measured, cases):
            errors += found
            for name, told, true in found:
                if true > told + EVEN:
                    print(f"{name}: told {told:.2%}, true {true:.2%}", flush=True)
            for words in refused:
                print(f"refused: {words}", flush=True)
    told, true = np.array([one[1:] for one in errors]).T
    above = true > told + EVEN
    print(
        f"{above.sum()} of {above.size} true errors lie above what is told, the worst "
        f"{(true / np.maximum(told, EVEN)).max():.1f} times; told {np.median(told):.2%} in the median, true "
        f"{np.median(true):.2%}, at most {true.max():.2%}; {perf_counter() - begun:.0f} s"
    )


if __name__ == "__main__":
    given = [int(word) for word in sys.argv[1:]]
    main(*(given + [44, 2][len(given) :]))
