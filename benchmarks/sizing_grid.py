"""Five hundred plain duties, drawn with a fixed seed: how many end with designs, and why the others do not.

    python benchmarks/sizing_grid.py [how many] [which first]

100 to 8000 t/h of coal, stone, ore or grain over 30 to 6000 m, 200 m down to 300 m up, no steeper than 20 deg, at -30
to 45 degC, some colder by night, in SI or of the US trade. Any number of them, the first ones without a second figure.
Every design is also calculated again from its spec alone with all its load states: no check may fail there.
"""

from __future__ import annotations

import os

os.environ["OMP_NUM_THREADS"] = "1"  # before numpy: BLAS reads it once
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import math
import sys
import time
from collections.abc import Iterator
from typing import Any

import numpy as np

from conveyor import shelf
from conveyor.errors import ConveyorError
from conveyor.models.sizing import SizingDuty
from conveyor.sizing import size_conveyor
from conveyor.studies.loads import every_load

COUNT = 500
SEED = 20_000
STEEPEST = math.sin(math.radians(20.0))
MATERIALS: dict[str, dict[str, Any]] = {
    "coal": {"density": 850, "surcharge": 20, "lump": 150, "abrasiveness": "medium"},
    "stone": {"density": 1600, "surcharge": 20, "lump": 100, "abrasiveness": "medium"},
    "ore": {"density": 2200, "surcharge": 15, "lump": 100, "abrasiveness": "high"},
    "grain": {"density": 750, "surcharge": 10, "lump": 5, "abrasiveness": "low"},
}


def drawn(count: int = COUNT) -> Iterator[dict[str, Any]]:
    """Duties as they would stand in files; the first ones do not depend on how many are asked for."""
    random = np.random.default_rng(SEED)
    for _ in range(count):
        name = str(random.choice(list(MATERIALS)))
        flow, length = (float(np.exp(random.uniform(*np.log(ends)))) for ends in ((100.0, 8000.0), (30.0, 6000.0)))
        steepest = STEEPEST * length
        lift = float(random.uniform(-min(200.0, steepest), min(300.0, steepest)))
        lift *= float(random.choice([0.0, 1.0, 1.0, 1.0]))
        warm = float(random.uniform(-30.0, 45.0))
        night = float(random.choice([0.0, 0.0, 10.0, 20.0]))
        of, us = MATERIALS[name], bool(random.integers(4) == 0)
        duty: dict[str, Any] = {
            "name": f"{name}, {flow:.0f} t/h, {length:.0f} m, {lift:+.0f} m, {warm:.0f} degC{', US' if us else ''}",
            "material": {
                "name": name,
                "density": f"{of['density']} kg/m^3",
                "flow": f"{flow:.0f} t/h",
                "surcharge_angle": f"{of['surcharge']} deg",
            },
            "lump": f"{of['lump']} mm",
            "abrasiveness": of["abrasiveness"],
            "length": f"{length:.0f} m",
            "lift": f"{lift:.0f} m",
            "ambient": {"temperature": f"{warm:.0f} degC"},
            "operation": {"hours_per_year": "5000 h", "price": "0.12 EUR/kWh"},
            "covers": [shelf.compound("standard-cover")],
            "report": {"units": "US" if us else "SI"},
        }
        yield duty | ({"coldest": f"{max(-40.0, warm - night):.0f} degC"} if night else {})


def main(count: int = 40, first: int = 0) -> None:
    answered, failing, spent = 0, 0, list[float]()
    duties = list(drawn())[first : first + count]
    for i, data in enumerate(duties, start=first):
        begun = time.process_time()
        try:
            found = size_conveyor(SizingDuty.from_data(data), best=1)
            said = f"{found.best.choice.trough.width.belt * 1e3:.0f} mm, {found.calculated} calculated"
            answered += 1
        except ConveyorError as error:
            found, said = None, f"NO DESIGN: {error}"
        except Exception as error:  # noqa: BLE001 a fault of the package: counted, and the others go on
            found, said = None, f"ENDS IN {type(error).__name__}: {error}"
        spent.append(time.process_time() - begun)
        if found is not None:
            failed = [check for check in every_load(found.best.conveyor).governing if check.failed]
            failing += bool(failed)
            said += "".join(f"\n      FAILS: {check.subject.text()}" for check in failed)
        print(f"{i:>3} {spent[-1]:>5.1f} s  {data['name']}: {said}", flush=True)
    print(
        f"{answered} of {len(duties)} duties end with designs, {failing} of which fail a check; "
        f"{np.median(spent):.1f} s each in the middle, {max(spent):.1f} s at most"
    )


if __name__ == "__main__":
    main(*map(int, sys.argv[1:3]))
