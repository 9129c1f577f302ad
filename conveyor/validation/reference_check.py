"""A calculated figure against a published or closed one."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class ReferenceCheck:
    """A figure of this package compared with the same figure from elsewhere.

    Parameters
    ----------
    source : str
        Source of the expected figure.
    quantity : str
        Name of the figure, with its unit.
    expected, got : float or str
        The two figures; text where the answer is a status.
    deviation, tolerance : float
        |got/expected - 1| (|got - expected| for lengths over R) and its allowed value [-].
    passed : bool
        True if the deviation is within the tolerance.
    """

    source: str
    quantity: str
    expected: float | str
    got: float | str
    deviation: float
    tolerance: float
    passed: bool = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "passed", self.deviation <= self.tolerance)


def relative_check(source: str, quantity: str, expected: float, got: float, tolerance: float) -> ReferenceCheck:
    """Check by relative difference."""
    return ReferenceCheck(source, quantity, expected, got, abs(got / expected - 1.0), tolerance)


def printed_check(source: str, quantity: str, figure: str, got: float, units: float = 0.5) -> ReferenceCheck:
    """Compare with a printed figure to `units` of its last digit."""
    decimals = len(figure.partition(".")[2])
    expected = float(figure)
    return relative_check(source, quantity, expected, got, units * 10.0**-decimals / abs(expected))
