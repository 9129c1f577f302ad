"""Contact problems of extreme numbers, drawn (seeded): every input from the smallest to the largest that it takes."""

from __future__ import annotations

import random
import warnings

import numpy as np

from conveyor.contact import ContactProblem, CreepSpectrum, solve
from conveyor.errors import ConveyorError

_EXTREMES = (5e-324, 1e-300, 1e-100, 1e-30, 1e-12, 1e-6, 1e-3, 1.0, 1e3, 1e12, 1e30, 1e100, 1e300)


def drawn(seed: int) -> dict[str, object]:
    """Arguments of a contact: one or two of them extreme, the others usual over some decades."""
    seeded = random.Random(seed)  # noqa: S311 a repeatable test, no secret

    def decades(low: float, high: float) -> float:
        return 10.0 ** seeded.uniform(low, high)

    terms = seeded.choice((0, 1, 3))
    given: dict[str, float] = {
        "radius": min(decades(-3.0, -0.3), 0.5),
        "pressure": decades(-6.0, 0.5),
        "thickness": decades(-2.0, 1.0),
        "poisson": seeded.choice((0.5, 0.5, 0.3, 0.0)),
        "instantaneous": decades(-3.0, -0.1),
        "time": decades(-4.0, 2.0),
        "weight": seeded.random(),
    }
    for name in seeded.sample(list(given), seeded.choice((0, 1, 2))):
        given[name] = seeded.choice(_EXTREMES)
    weights = np.array([given.pop("weight"), 0.7, 0.2][:terms])
    instantaneous, time = given.pop("instantaneous"), given.pop("time")
    if terms:
        weights = weights / weights.sum() * (1.0 - min(instantaneous, 1.0))
    times = [time * 30.0**k for k in range(terms)]
    creep = (instantaneous if terms else 1.0, weights.tolist(), times)
    return {"support": seeded.choice(("free", "confined", "half-space")), "creep": creep, **given}


def ending(seed: int) -> str:
    """How a contact of a seed ends: its status, or "refused"; warnings are faults."""
    arguments = drawn(seed)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            creep = CreepSpectrum(*arguments.pop("creep"))  # type: ignore[misc]
            solution = solve(ContactProblem(creep=creep, **arguments), rtol=1e-4, throw=False)  # type: ignore[arg-type]
        except ConveyorError as error:
            return "refused" if str(error) else "refused without a word"
    assert solution.status.name == "OK" or solution.message
    if solution.status.name in {"OK", "TOO_DEEP"}:
        assert np.isfinite([solution.friction, solution.half_width]).all()
        assert solution.friction >= -solution.error_estimate
    return solution.status.name
