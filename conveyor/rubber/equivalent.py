"""The equivalent-linear series: moduli at the strain amplitude that their own contact works at."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from conveyor.errors import NoSolutionError, RangeError
from conveyor.rubber.arrays import positive
from conveyor.rubber.prony import PronySeries
from conveyor.rubber.strain import AmplitudeFactors

Worked: TypeAlias = tuple[float, float]
"""Strain amplitude [-] and angular frequency [rad/s] that a series is worked at."""

_SOFTENS, _SLOWS = 0.65, 0.2
"""Exponents of E' in strain and frequency, for the first step alone: between a half-space (1/2, 1/2) and a thin cover;
0.35 to 0.73 and 0 to 0.25 were seen on the shelf's compounds."""
_GUESSES = 2
_LARGEST_STEP = math.log(3.0)
_MOST_STEPS = 30


def softened(series: PronySeries, *, storage_factor: float, loss_factor: float, omega: float) -> PronySeries:
    """Equivalent-linear series at a working strain.

    Parameters
    ----------
    series : PronySeries
        At small strain, or at that of the master curve [Pa, s].
    storage_factor : float
        f' of E' at `omega` [-].
    loss_factor : float
        f'' of E'' at every frequency [-].
    omega : float
        Angular frequency at which the rubber works [rad/s].

    Returns
    -------
    PronySeries
        At `omega` E' is f' times, E'' f'' times the old: E_e times r and every modulus times s p + g (1 - p),
        p = (ωτ)²/(1 + (ωτ)²), so that s falls on what is slow there and g on what is fast. Of all r, s, g that do so
        those nearest to the mean of f' and f'' are taken (least squares); a positive spectrum, so E' and E'' belong
        together (Kramers-Kronig) at every frequency.

    Raises
    ------
    InputError
        If a number is not finite and > 0.
    NoSolutionError
        If r, s or g is not > 0: no solid has these moduli.

    Examples
    --------
    >>> series = PronySeries(4e6, [8e6], [1e-2])
    >>> soft = softened(series, storage_factor=0.8, loss_factor=0.9, omega=100.0)
    >>> (
    ...     round(soft.equilibrium),
    ...     round(float(soft.storage(100.0) / series.storage(100.0)), 12),
    ...     round(float(soft.moduli[0])),
    ... )
    (2800000, 0.8, 7200000)
    """
    stiff, lossy = positive("storage_factor", storage_factor, "-"), positive("loss_factor", loss_factor, "-")
    turn = positive("omega", omega, "rad/s") * series.times
    if turn.size == 0:
        return PronySeries(stiff * series.equilibrium, series.moduli, series.times)
    slow, fast, quick = turn**2 / (1.0 + turn**2), 1.0 / (1.0 + turn**2), turn / (1.0 + turn**2)
    storage = np.array([series.equilibrium, series.moduli @ slow**2, series.moduli @ (slow * fast)])
    loss = np.array([0.0, series.moduli @ (slow * quick), series.moduli @ (fast * quick)])
    shares = np.stack([storage / storage.sum(), loss / loss.sum()])
    mean = 0.5 * (stiff + lossy)
    r, s, g = (mean + np.linalg.lstsq(shares, np.array([stiff - mean, lossy - mean]), rcond=None)[0]).tolist()
    if not min(r, s, g) > 0.0:
        raise NoSolutionError(
            f"factors {stiff:.4g} of E' and {lossy:.4g} of E'' at {omega:.4g} rad/s leave {r:.3g} of the equilibrium "
            f"modulus, {s:.3g} of the slow and {g:.3g} of the fast part of the spectrum: no solid changes so; check "
            "that sweep and master curve are of one compound and the reference strain is right, or work at a smaller "
            "strain or load, or nearer the temperatures of the data"
        )
    return PronySeries(r * series.equilibrium, (s * slow + g * fast) * series.moduli, series.times)


@dataclass(frozen=True, eq=False)
class EquivalentLinear:
    """A series at the strain its own contact works at.

    Attributes
    ----------
    series : PronySeries
        Softened series [Pa, s].
    strain : float
        Working strain amplitude with it [-].
    omega : float
        Angular frequency at which the factors were taken [rad/s].
    storage_factor, loss_factor : float
        Of E' and E'' [-].
    steps : int
        Evaluations of the working strain.
    """

    series: PronySeries
    strain: float
    omega: float
    storage_factor: float
    loss_factor: float
    steps: int


def equivalent_linear(
    series: PronySeries,
    factors: AmplitudeFactors,
    strain_of: Callable[[PronySeries], Worked],
    *,
    temperature: float,
    swept: PronySeries | None = None,
    rtol: float = 1e-3,
) -> EquivalentLinear:
    """Iterate series, working strain, factors until the strain no longer changes.

    Parameters
    ----------
    series : PronySeries
        At the strain of the master curve, at the working temperature [Pa, s].
    factors : AmplitudeFactors
        Of the compound [-].
    strain_of : callable
        Working strain amplitude [-] and angular frequency [rad/s] of whatever is made of a series.
    temperature : float
        Absolute temperature [K].
    swept : PronySeries, optional
        Beyond the sweeps: the series at the nearest temperature they reach [Pa, s]. The change of each modulus is held
        then where that is less than its ratio, f = 1 + (f_nearest - 1) E_nearest/E at the working frequency: a filler
        network adds to a stiffening polymer, it does not stiffen with it.
    rtol : float
        Relative change of strain and frequency at which to stop [-].

    Returns
    -------
    EquivalentLinear
        Series, strain, frequency, factors, and steps taken.

    Raises
    ------
    NoSolutionError
        It does not settle within 30 steps, or the softened series would be a fluid.
    RangeError
        The working strain is outside the sweeps.

    Notes
    -----
    Fixed point of ln strain -> ln strain_of(softened(series)), by secants on the change of the strain, from the second
    step on; a secant whose slope would lead away, or that steps by more than a factor 3, gives way to half the plain
    step or to that factor.

    Examples
    --------
    >>> import numpy as np
    >>> from conveyor.rubber.kraus import KrausLaw
    >>> from conveyor.rubber.strain import StrainSweep
    >>> strain = np.geomspace(1e-4, 0.2, 12)
    >>> law = KrausLaw(10e6, 4e6, 1.2e6, 0.8e6, 0.01, 0.6, 0.01, 0.6)
    >>> sweep = StrainSweep(293.15, 1.0, strain, law.storage(strain), law.loss(strain))
    >>> soft = equivalent_linear(  # stress of 0.1 MPa at 100 rad/s
    ...     PronySeries(6e6, [4e6], [1e-2]),
    ...     AmplitudeFactors([sweep], 1e-4),
    ...     lambda s: (1e5 / float(abs(s.modulus(100.0))), 100.0),
    ...     temperature=293.15,
    ... )
    >>> round(soft.strain, 4), round(soft.storage_factor, 3)
    (0.0181, 0.6)
    """
    task = StrainTask(series, factors, temperature, swept)
    (answer,) = equivalent_linear_many([task], lambda _, asked: [strain_of(one) for one in asked], rtol=rtol)
    if isinstance(answer, EquivalentLinear):
        return answer
    raise answer


@dataclass(frozen=True, eq=False)
class StrainTask:
    """A series to be taken at the strain it works at; attributes as the arguments of `equivalent_linear`."""

    series: PronySeries
    factors: AmplitudeFactors
    temperature: float
    swept: PronySeries | None = None


def equivalent_linear_many(
    tasks: Sequence[StrainTask],
    strains_of: Callable[[list[int], list[PronySeries]], Sequence[Worked | NoSolutionError]],
    *,
    rtol: float = 1e-3,
) -> list[EquivalentLinear | NoSolutionError | RangeError]:
    """Iterate many series side by side, each as `equivalent_linear` does.

    Parameters
    ----------
    tasks : sequence of StrainTask
        Series.
    strains_of : callable
        Working strain and frequency of whatever is made of a series, or why there is none: of the numbers of the tasks
        that go on, and a series of each.
    rtol : float
        Relative change of strain and frequency at which to stop [-].

    Returns
    -------
    list
        In their order the answers, or why there is none.
    """
    positive("rtol", rtol, "-")
    answers: dict[int, EquivalentLinear | NoSolutionError | RangeError] = {}
    going = {i: _iteration(task, rtol) for i, task in enumerate(tasks)}
    asked = {i: next(steps) for i, steps in going.items()}
    while asked:
        heard = zip(list(asked), strains_of(list(asked), list(asked.values())), strict=True)
        for i, worked in heard:
            try:
                if isinstance(worked, NoSolutionError):
                    raise worked
                asked[i] = going[i].send(worked)
            except StopIteration as done:
                answers[i] = done.value
            except (NoSolutionError, RangeError) as error:
                answers[i] = error
            if i in answers:
                del asked[i]
    return [answers[i] for i in range(len(tasks))]


def _iteration(task: StrainTask, rtol: float) -> Generator[PronySeries, Worked, EquivalentLinear]:
    """Ask for the strain of one series after the other until it no longer changes."""
    series, factors, temperature = task.series, task.factors, task.temperature
    strain, omega = yield series
    first = trial = math.log(positive("strain_of's strain", strain, "-"))
    stiff = 1.0
    for _ in range(_GUESSES):
        stiff = float(factors.storage(math.exp(trial), temperature))
        trial = first - _SOFTENS * math.log(stiff)
    omega *= stiff**_SLOWS
    before: tuple[float, float] | None = None
    for step in range(2, _MOST_STEPS + 1):
        amplitude = math.exp(trial)
        f = float(factors.storage(amplitude, temperature))
        g = float(factors.loss(amplitude, temperature))
        if task.swept is not None:
            there, here = complex(task.swept.modulus(omega)), complex(series.modulus(omega))
            f = 1.0 + min(1.0, there.real / here.real) * (f - 1.0)
            g = 1.0 + min(1.0, there.imag / here.imag) * (g - 1.0)
        soft = softened(series, storage_factor=f, loss_factor=g, omega=omega)
        strain, heard = yield soft
        change = math.log(positive("strain_of's strain", strain, "-")) - trial
        if abs(change) < rtol and abs(math.log(heard / omega)) < rtol:
            return EquivalentLinear(soft, strain, omega, f, g, step)
        move = _next_move(trial, change, before)
        before, omega = (trial, change), heard
        trial += move
    raise NoSolutionError(
        f"the working strain did not settle in {_MOST_STEPS} steps: last {math.exp(trial):.4g}, "
        f"changing by {abs(change):.2g} of itself; ask for a larger rtol, or smooth the strain sweeps (Kraus' law)"
    )


def _next_move(trial: float, change: float, before: tuple[float, float] | None) -> float:
    """Secant of the change; half the plain step where the secant points away from the fixed point."""
    move = change
    if before is not None and trial != before[0]:
        slope = (change - before[1]) / (trial - before[0])
        move = -change / slope if slope < 0.0 else 0.5 * change
    return math.copysign(min(abs(move), _LARGEST_STEP), move)
