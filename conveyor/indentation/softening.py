"""Working strain of a cover under rolls and its moduli at that strain: the equivalent-linear cover of a strand.

The strain is that of the rolls' contact (`working_strains`) at the loss-weighted line load of the strand;
moduli are softened by the compound's strain sweeps (conveyor.rubber.equivalent_series) until both agree.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from conveyor.arguments.limits import require, require_positive
from conveyor.contact import Status, solve_many, working_strains
from conveyor.errors import NoSolutionError, RangeError
from conveyor.indentation import RollContact, to_problems
from conveyor.indentation.indentation_results import no_contact_error
from conveyor.rubber import (
    AmplitudeFactors,
    EquivalentLinear,
    PronySeries,
    StrainTask,
    equivalent_linear_many,
    series_at_strains,
)
from conveyor.rubber.equivalent_series import WorkingPoint

Array = NDArray[np.float64]

LOAD_EXPONENT = 4.0 / 3.0
"""Exponent of the indentation resistance in the line load (Winkler), to weight the loads of a strand by their loss."""
STRAIN_RTOL: Final = 5e-3
"""Relative tolerance of the working strain [-]; sweeps repeat to a few per cent."""
_CONTACT_RTOL = 1e-3
INTERIOR_SAMPLING: Final = (12, 32)
"""Depths and points at which the strain inside a cover is sampled: relative error of strain and frequency 3e-3,
against 28 and 96."""
COARSE_SAMPLING: Final = (4, 16)
"""Coarse sampling: 2e-3 of the indentation at a third of the time, seen on three compounds, 0 to 40 °C."""


@dataclass(frozen=True)
class WorkingStrain:
    """Working strain of a strand's cover and its modulus factors.

    Attributes
    ----------
    line_load : float
        Line load of the strain: mean over the strand's rolls, weighted by their loss [N/m].
    strain : float
        Single strain amplitude, weighted with the dissipation over the cover's depth [-].
    frequency : float
        Frequency of the factors, weighted with the dissipation [Hz].
    storage_factor, loss_factor : float
        E' and E'' over those of the master curve [-].
    """

    line_load: float
    strain: float
    frequency: float
    storage_factor: float
    loss_factor: float


def loss_weighted_load(line_loads: Array, weights: Array) -> float:
    """Mean line load of rolls, weighted by their loss, f proportional to w^(4/3) (a Winkler layer).

    Parameters
    ----------
    line_loads : ndarray
        Line loads along all rolls, shape (n,), at least 0 [N/m].
    weights : ndarray
        Quadrature weights times the number of such rolls, shape (n,), at least 0 [m].

    Returns
    -------
    float
        Loss-weighted line load of a strand [N/m].

    Raises
    ------
    InputError
        All line loads are zero.

    Examples
    --------
    >>> round(loss_weighted_load(np.array([8.0, 1.0]), np.array([1.0, 1.0])), 3)  # (16·8 + 1·1)/(16 + 1)
    7.588
    """
    lost = weights * line_loads**LOAD_EXPONENT
    whole = float(lost.sum())
    require(whole > 0.0, "line_loads", whole, "> 0: a roll that carries something")
    return float(lost @ line_loads) / whole


@dataclass(frozen=True, eq=False)
class SofteningCover:
    """A cover whose moduli depend on its working strain under the rolls.

    Attributes
    ----------
    contact : RollContact
        With the series at the strain of the master curve.
    line_load : float
        w [N/m].
    factors : AmplitudeFactors
        Amplitude factors of the compound.
    temperature : float
        Temperature of the cover [K].
    swept : PronySeries or None
        Series at the nearest temperature of the sweeps, where `temperature` lies beyond them.
    inside : tuple of int
        Depths and points at which the strain is sampled.
    """

    contact: RollContact
    line_load: float
    factors: AmplitudeFactors
    temperature: float
    swept: PronySeries | None = None
    inside: tuple[int, int] = INTERIOR_SAMPLING


SoftCover: TypeAlias = tuple[PronySeries, WorkingStrain]
"""Series at the working strain, and that strain."""


def soften_or_raise(works: Sequence[SofteningCover]) -> list[SoftCover]:
    """Series of covers at their working strains, as `soften_covers`; the first error is raised.

    Parameters
    ----------
    works : sequence of SofteningCover
        Covers, each with its line load [N/m] and temperature [K].

    Returns
    -------
    list of (PronySeries, WorkingStrain)
        In the order of the covers.

    Raises
    ------
    NoSolutionError
        The contact has no solution, the strain does not converge, or the softened rubber would be a fluid.
    RangeError
        The strain is outside the sweeps.

    Examples
    --------
    >>> from conveyor.rubber import StrainSweep
    >>> strain, storage = (
    ...     [1e-4, 1.5e-4, 2e-4, 1e-3, 1e-2, 1e-1],
    ...     [11.0e6, 11.0e6, 10.9e6, 10.4e6, 7.7e6, 3.5e6],
    ... )
    >>> factors = AmplitudeFactors([StrainSweep(293.15, 1.0, strain, storage, [1.4e6] * 6)], 1e-4)
    >>> contact = RollContact(
    ...     radius=0.08, spacing=1.5, cover_thickness=0.006, speed=5.0, series=PronySeries(8e6, [3e6], [1e-3])
    ... )
    >>> [(series, at)] = soften_or_raise([SofteningCover(contact, 3000.0, factors, 293.15)])
    >>> bool(abs(factors.storage(at.strain, 293.15) / at.storage_factor - 1.0) < STRAIN_RTOL)
    True
    """
    covers: list[SoftCover] = []
    for soft in soften_covers(works):
        if not isinstance(soft, tuple):
            raise soft
        covers.append(soft)
    return covers


def soften_covers(works: Sequence[SofteningCover]) -> list[SoftCover | NoSolutionError | RangeError]:
    """Series of covers at their working strains, solved in a batch.

    Parameters
    ----------
    works : sequence of SofteningCover
        Covers, each with its line load [N/m] and temperature [K].

    Returns
    -------
    list
        Series and working strain of each cover, or the error instead.

    Raises
    ------
    InputError
        The load of a contact is out of range.

    Examples
    --------
    >>> soften_covers([])
    []
    """
    coarsely = itertools.chain([True], itertools.repeat(False))

    def strains_of(asked: list[int], series: list[PronySeries]) -> list[WorkingPoint | NoSolutionError]:
        first = next(coarsely)  # the first strain is but a start
        problems = to_problems(
            [replace(works[i].contact, series=one) for i, one in zip(asked, series, strict=True)],
            [works[i].line_load for i in asked],
        )
        solved = dict(zip(asked, solve_many(problems, _CONTACT_RTOL), strict=True))
        alike: dict[tuple[int, int], list[int]] = {}
        for i, one in solved.items():
            if one.status is Status.OK:
                alike.setdefault(COARSE_SAMPLING if first else works[i].inside, []).append(i)
        worked: dict[int, WorkingPoint] = {}
        for (depths, points), members in alike.items():
            strained = working_strains([solved[i] for i in members], depths=depths, points=points)
            worked |= {
                i: _strain_and_frequency(works[i].contact, *pair) for i, pair in zip(members, strained, strict=True)
            }
        return [worked[i] if i in worked else NoSolutionError(solved[i].message) for i in asked]

    answers = equivalent_linear_many(_strain_tasks(works), strains_of, rtol=STRAIN_RTOL)
    return [_soft_cover(work, answer) for work, answer in zip(works, answers, strict=True)]


def soften_at_strains(
    works: Sequence[SofteningCover], worked: Sequence[WorkingPoint]
) -> list[SoftCover | NoSolutionError | RangeError]:
    """Series of covers at given strains; no contact is solved.

    Parameters
    ----------
    works : sequence of SofteningCover
        Covers, each with its line load [N/m] and temperature [K].
    worked : sequence of tuple of float
        Strain amplitude [-] and angular frequency [rad/s] of each.

    Returns
    -------
    list
        Series and working strain of each cover, or the error instead.

    Raises
    ------
    InputError
        A strain or a frequency is not positive.

    Examples
    --------
    At the strain of the master curve the rubber is that of the master curve.

    >>> from conveyor.rubber import StrainSweep
    >>> strain, storage = (
    ...     [1e-4, 1.5e-4, 2e-4, 1e-3, 1e-2, 1e-1],
    ...     [11.0e6, 11.0e6, 10.9e6, 10.4e6, 7.7e6, 3.5e6],
    ... )
    >>> factors = AmplitudeFactors([StrainSweep(293.15, 1.0, strain, storage, [1.4e6] * 6)], 1e-4)
    >>> contact = RollContact(
    ...     radius=0.08, spacing=1.5, cover_thickness=0.006, speed=5.0, series=PronySeries(8e6, [3e6], [1e-3])
    ... )
    >>> [(series, at)] = soften_at_strains([SofteningCover(contact, 3000.0, factors, 293.15)], [(1e-4, 600.0)])
    >>> round(at.storage_factor, 6), round(at.loss_factor, 6)
    (1.0, 1.0)
    """
    for strain, omega in worked:
        require_positive(strain=strain, angular_frequency=omega)
    return [
        _soft_cover(work, answer)
        for work, answer in zip(works, series_at_strains(_strain_tasks(works), worked), strict=True)
    ]


def _strain_tasks(works: Sequence[SofteningCover]) -> list[StrainTask]:
    return [StrainTask(work.contact.series, work.factors, work.temperature, work.swept) for work in works]


def _strain_and_frequency(contact: RollContact, strain: float, wave_number: float) -> WorkingPoint:
    """Strain [-] and angular frequency [rad/s] of a contact from its strain and wave number [-]."""
    return strain, wave_number * 2.0 * math.pi / contact.spacing * contact.speed


def _soft_cover(
    work: SofteningCover, answer: EquivalentLinear | NoSolutionError | RangeError
) -> SoftCover | NoSolutionError | RangeError:
    if isinstance(answer, NoSolutionError):
        return no_contact_error(work.contact, (work.line_load,), answer)
    if isinstance(answer, RangeError):
        return answer
    strain = WorkingStrain(
        work.line_load,
        answer.strain,
        answer.omega / (2.0 * math.pi),
        answer.storage_factor,
        answer.loss_factor,
    )
    return answer.series, strain
