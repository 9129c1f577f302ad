"""A roll under a belt in SI units: cover, speed, rubber, and what is behind the cover."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from conveyor.arguments.limits import require_number, require_positive
from conveyor.errors import InputError
from conveyor.rubber import PronySeries

Support = Literal["confined", "free", "half-space", "belt"]


@dataclass(frozen=True)
class Backing:
    """Carcass and other cover behind the cover that runs on the rolls, per width.

    Parameters
    ----------
    tension : float
        T - m' V², effective tension of the moving belt [N/m].
    bending : float
        D' of the carcass, flat [N m].
    bending_loss : float
        tan δ of the carcass in bending [-].
    stretching : float
        K, in-plane stiffness of the carcass [N/m].
    cover_thickness : float
        Of the other cover [m].
    series : PronySeries
        Of the other cover at its temperature [Pa, s].
    """

    tension: float
    bending: float
    bending_loss: float
    stretching: float
    cover_thickness: float
    series: PronySeries


@dataclass(frozen=True)
class RollContact:
    """One kind of roll under one cover at one speed and temperature.

    Parameters
    ----------
    radius : float
        R, of the roll [m].
    spacing : float
        λ, of the idler sets [m]; at least 2 R.
    cover_thickness : float
        h, of the cover the roll runs on, at most λ unless `support` is a half-space [m].
    speed : float
        V, of the belt [m/s].
    series : PronySeries
        Relaxation spectrum of the cover at its temperature [Pa, s].
    poisson : float
        ν of the rubber [-].
    support : {"confined", "free", "half-space", "belt"}
        Backing of the cover: a stiff carcass, nothing (the paper's belt), endless rubber, or the flexible belt.
    backing : Backing, optional
        Belt behind the cover; with support "belt" only.
    """

    radius: float
    spacing: float
    cover_thickness: float
    speed: float
    series: PronySeries
    poisson: float = 0.5
    support: Support = "confined"
    backing: Backing | None = None

    def __post_init__(self) -> None:
        if (self.support == "belt") != (self.backing is not None):
            raise InputError(f"backing = {self.backing!r}: support {self.support!r}; a belt, and no other, has one")
        for name in ("radius", "spacing", "cover_thickness", "speed"):
            require_number(**{name: getattr(self, name)})
            require_positive(**{name: getattr(self, name)})
        if self.support != "half-space" and self.cover_thickness > self.spacing:
            raise InputError(
                f"cover_thickness = {self.cover_thickness:g} m is more than spacing = {self.spacing:g} m: both are in"
                ' metres; endless rubber has support "half-space"'
            )

    @property
    def pull(self) -> float | None:
        """Effective tension of the belt behind the cover, per width [N/m]; None on another support."""
        return None if self.backing is None else self.backing.tension
