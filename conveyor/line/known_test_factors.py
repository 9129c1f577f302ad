"""Test factors of compounds: each is a constant of its compound, solved once a process."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from typing import Final, TypeAlias

from conveyor.errors import InputError, NoSolutionError, RangeError
from conveyor.indentation import RollContact
from conveyor.line.rolling_test_theory import compound_test_factors, replica_band
from conveyor.models import RubberCompound
from conveyor.rubber.rolling_test_factor import RollingTestFactor

TestFactorAnswer: TypeAlias = RollingTestFactor | NoSolutionError | RangeError | InputError | None
"""Test factor of a compound, None without tests, or the error."""

_BandKey: TypeAlias = tuple[bytes, tuple[float, ...], float, tuple[float, float]]


class KnownTestFactors:
    """Cache of test factors, by the value of a compound and whether strain softens it; the last used are kept."""

    MOST: Final = 1024
    """Largest number of factors kept."""

    def __init__(self) -> None:
        self._known: dict[tuple[bytes, bool], TestFactorAnswer] = {}
        self._bands: dict[_BandKey, tuple[float, float]] = {}

    def solve(self, compounds: Iterable[RubberCompound], *, softened: bool) -> None:
        """Solve the unknown factors of compounds in one batch."""
        asked = {one.fingerprint: one for one in compounds if (one.fingerprint, softened) not in self._known}
        if asked:
            answers = compound_test_factors(list(asked.values()), softened=softened)
            for one, answer in zip(asked.values(), answers, strict=True):
                self.keep(one, answer, softened=softened)

    def of(self, compound: RubberCompound, *, softened: bool) -> TestFactorAnswer:
        """Factor of a compound, solved if it is unknown."""
        self.solve([compound], softened=softened)
        answer = self._known[compound.fingerprint, softened]
        self.keep(compound, answer, softened=softened)
        return answer

    def replica_band(
        self, compound: RubberCompound, contact: RollContact, load: float, temperatures: tuple[float, float]
    ) -> tuple[float, float]:
        """Band of a compound's factor by extrapolation from its tests, as `rolling_test_theory.replica_band`.

        Speed and load are rounded to half an octave, by which the band changes by less than a tenth of itself: rolls of
        a conveyor and designs of a study share it.
        """
        rough = replace(contact, speed=_round_to_half_octave(contact.speed))
        load = _round_to_half_octave(load)
        size = (rough.radius, rough.spacing, rough.cover_thickness, rough.speed, rough.poisson)
        key = (compound.fingerprint, size, load, temperatures)
        band = self._bands.pop(key, None)
        self._bands[key] = band = replica_band(compound, rough, load, temperatures) if band is None else band
        for oldest in list(self._bands)[: max(0, len(self._bands) - self.MOST)]:
            del self._bands[oldest]
        return band

    def keep(self, compound: RubberCompound, answer: TestFactorAnswer, *, softened: bool) -> None:
        """Keep a factor as the last used, and drop those beyond `MOST`."""
        key = (compound.fingerprint, softened)
        self._known.pop(key, None)
        self._known[key] = answer
        for oldest in list(self._known)[: max(0, len(self._known) - self.MOST)]:
            del self._known[oldest]


def _round_to_half_octave(value: float) -> float:
    return float(2.0 ** (0.5 * round(2.0 * math.log2(value))))


TEST_FACTORS: Final = KnownTestFactors()
"""Test factors of this process."""
