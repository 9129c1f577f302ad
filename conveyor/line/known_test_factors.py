"""Test factors of compounds: each is a constant of its compound, solved once a process."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final, TypeAlias

from conveyor.errors import InputError, NoSolutionError, RangeError
from conveyor.line.rolling_test_theory import compound_test_factors
from conveyor.models import RubberCompound
from conveyor.rubber.rolling_test_factor import RollingTestFactor

TestFactorAnswer: TypeAlias = RollingTestFactor | NoSolutionError | RangeError | InputError | None
"""Test factor of a compound, None without tests, or the error."""


class KnownTestFactors:
    """Cache of test factors, by the value of a compound and whether strain softens it; the last used are kept."""

    MOST: Final = 1024
    """Largest number of factors kept."""

    def __init__(self) -> None:
        self._known: dict[tuple[bytes, bool], TestFactorAnswer] = {}

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

    def keep(self, compound: RubberCompound, answer: TestFactorAnswer, *, softened: bool) -> None:
        """Keep a factor as the last used, and drop those beyond `MOST`."""
        key = (compound.fingerprint, softened)
        self._known.pop(key, None)
        self._known[key] = answer
        for oldest in list(self._known)[: max(0, len(self._known) - self.MOST)]:
            del self._known[oldest]


TEST_FACTORS: Final = KnownTestFactors()
"""Test factors of this process."""
