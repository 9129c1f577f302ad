"""Equivalent-linear series: moduli at the working strain of their own contact."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from conveyor.arguments.arrays import FloatArray, positive_number
from conveyor.errors import NoSolutionError, RangeError
from conveyor.rubber.prony import PronySeries
from conveyor.rubber.strain import AmplitudeFactors

WorkingPoint: TypeAlias = tuple[float, float]
"""Working strain amplitude [-] and angular frequency [rad/s]."""

_STRAIN_EXPONENT, _FREQUENCY_EXPONENT = 0.65, 0.2
"""Exponents of E' in strain and frequency, for the first step alone: between a half-space (1/2, 1/2) and a thin cover;
0.35 to 0.73 and 0 to 0.25 on the shelf's compounds."""
_FIRST_GUESSES = 2
_LEAST_CONTRACTION = 0.2
"""Share of a change of strain or frequency that a plain step leaves, taken at least: 0.02 to 0.1 in trials."""
_LARGEST_STEP = math.log(3.0)
_MOST_STEPS = 30


def soften_series(series: PronySeries, *, storage_factor: float, loss_factor: float, omega: float) -> PronySeries:
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
    >>> soft = soften_series(series, storage_factor=0.8, loss_factor=0.9, omega=100.0)
    >>> (
    ...     round(soft.equilibrium),
    ...     round(float(soft.storage(100.0) / series.storage(100.0)), 12),
    ...     round(float(soft.moduli[0])),
    ... )
    (2800000, 0.8, 7200000)
    """
    factors = (
        positive_number("storage_factor", storage_factor, "-"),
        positive_number("loss_factor", loss_factor, "-"),
    )
    (soft,) = _soften_many([series], np.array([factors]), np.array([positive_number("omega", omega, "rad/s")]))
    if isinstance(soft, NoSolutionError):
        raise soft
    return soft


def _soften_many(
    series: Sequence[PronySeries], factors: FloatArray, omega: FloatArray
) -> list[PronySeries | NoSolutionError]:
    """Soften each series by its factors of E' and E'', shape (b, 2), at ω, shape (b,)."""
    moduli, turn = np.zeros((2, len(series), max(1, *(one.times.size for one in series))))
    for row, one in enumerate(series):
        moduli[row, : one.moduli.size] = one.moduli
        turn[row, : one.times.size] = omega[row] * one.times
    slow, fast, quick = turn**2 / (1.0 + turn**2), 1.0 / (1.0 + turn**2), turn / (1.0 + turn**2)
    rubbery = np.array([one.equilibrium for one in series])
    storage = np.stack([rubbery, (moduli * slow**2).sum(-1), (moduli * slow * fast).sum(-1)])
    loss = np.stack([np.zeros(len(series)), (moduli * slow * quick).sum(-1), (moduli * fast * quick).sum(-1)])
    lossy = loss.sum(0) > 0.0
    a, b = storage / storage.sum(0), loss / np.where(lossy, loss.sum(0), 1.0)
    # a·x = half the difference of the factors and b·x = minus that, by the shortest x = y a + z b
    half, mean = 0.5 * (factors[:, 0] - factors[:, 1]), factors.mean(axis=1)
    aa, ab, bb = (a * a).sum(0), (a * b).sum(0), (b * b).sum(0)
    scale = half / np.where(lossy, aa * bb - ab * ab, 1.0)
    r, s, g = np.where(lossy, mean + scale * ((bb + ab) * a - (aa + ab) * b), factors[:, 0])
    made: list[PronySeries | NoSolutionError] = []
    for row, one in enumerate(series):
        n, parts = one.moduli.size, (r[row], s[row], g[row])
        if min(parts) > 0.0:
            held = s[row] * slow[row, :n] + g[row] * fast[row, :n]
            made.append(PronySeries(r[row] * one.equilibrium, held * one.moduli, one.times))
        else:
            made.append(_no_solid_error(factors[row].tolist(), float(omega[row]), parts))
    return made


def _no_solid_error(factors: Sequence[float], omega: float, parts: Sequence[float]) -> NoSolutionError:
    """Error: no solid has these factors at ω [rad/s]."""
    (stiff, lossy), (r, s, g) = factors, parts
    return NoSolutionError(
        f"factors {stiff:.4g} of E' and {lossy:.4g} of E'' at {omega:.4g} rad/s leave {r:.3g} of the equilibrium "
        f"modulus, {s:.3g} of the slow and {g:.3g} of the fast part of the spectrum: no solid changes so; check "
        "that sweep and master curve are of one compound and the reference strain is right, or work at a smaller "
        "strain or load, or nearer the temperatures of the data"
    )


@dataclass(frozen=True, eq=False)
class EquivalentLinear:
    """A series at the working strain of its own contact.

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
        Number of evaluations of the working strain.
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
    strain_of: Callable[[PronySeries], WorkingPoint],
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
        Working strain amplitude [-] and angular frequency [rad/s] with a series.
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
    Fixed point of ln strain -> ln strain_of(softened(series)), by secants on the change of the strain; the first slope
    from the fall of strain with E' and of E' with strain. A secant that would lead away is replaced by half the plain
    step, one longer than a factor 3 by that factor. It ends when the remaining change, by that slope and a fifth of the
    change at least, is within `rtol`; series and strain are those of the last step, whose contact is not solved again.

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
    """A series to soften to its working strain; attributes as the arguments of `equivalent_linear`."""

    series: PronySeries
    factors: AmplitudeFactors
    temperature: float
    swept: PronySeries | None = None


def equivalent_linear_many(
    tasks: Sequence[StrainTask],
    strains_of: Callable[[list[int], list[PronySeries]], Sequence[WorkingPoint | NoSolutionError]],
    *,
    rtol: float = 1e-3,
) -> list[EquivalentLinear | NoSolutionError | RangeError]:
    """Iterate many series side by side, each as `equivalent_linear` does.

    Parameters
    ----------
    tasks : sequence of StrainTask
        Series.
    strains_of : callable
        Working strains and frequencies, or errors, from the numbers of the unfinished tasks and a series of each.
    rtol : float
        Relative change of strain and frequency at which to stop [-].

    Returns
    -------
    list
        Result or error of each task, in their order.
    """
    positive_number("rtol", rtol, "-")
    answers: dict[int, EquivalentLinear | NoSolutionError | RangeError] = {}
    heard = _working_points(list(range(len(tasks))), [task.series for task in tasks], strains_of, answers)
    paths = {i: _StrainIteration(strain, omega) for i, (strain, omega) in heard.items()}
    for _ in range(_FIRST_GUESSES):
        trials = {i: (path.trial, path.omega) for i, path in paths.items()}
        for i, (stiff, _) in _softening_factors(tasks, trials, answers).items():
            paths[i].guess(stiff)
    going = {i: path for i, path in paths.items() if i not in answers}
    while going:
        softer = _series_at_trials(tasks, going, answers)
        heard = _working_points(list(softer), [series for series, _ in softer.values()], strains_of, answers)
        there = {i: (math.log(strain), going[i].omega) for i, (strain, _) in heard.items()}
        ahead = _softening_factors(tasks, there, {})
        for i, worked in heard.items():
            here = softer[i][1]
            going[i].next_step(*worked, here[0], ahead.get(i, here)[0])
        done = {i: going[i] for i in heard if going[i].left < rtol}
        for i, (series, (stiff, lossy)) in _series_at_trials(tasks, done, answers).items():
            path = done[i]
            answers[i] = EquivalentLinear(series, math.exp(path.trial), path.omega, stiff, lossy, path.steps)
        for i, path in going.items():
            if i not in answers and path.steps == _MOST_STEPS:
                answers[i] = path.no_convergence_error()
        going = {i: path for i, path in going.items() if i not in answers}
    return [answers[i] for i in range(len(tasks))]


def series_at_strains(
    tasks: Sequence[StrainTask], worked: Sequence[WorkingPoint]
) -> list[EquivalentLinear | NoSolutionError | RangeError]:
    """Soften series to known strains.

    Parameters
    ----------
    tasks : sequence of StrainTask
        Series.
    worked : sequence of tuple of float
        Strain amplitude [-] and angular frequency [rad/s] of each.

    Returns
    -------
    list
        Result or error of each task, in their order.
    """
    answers: _Results = {}
    paths = {i: _StrainIteration(*one) for i, one in enumerate(worked)}
    for i, (series, (stiff, lossy)) in _series_at_trials(tasks, paths, answers).items():
        answers[i] = EquivalentLinear(series, *worked[i], stiff, lossy, 0)
    return [answers[i] for i in range(len(tasks))]


_Results: TypeAlias = dict[int, EquivalentLinear | NoSolutionError | RangeError]


def _working_points(
    asked: list[int],
    series: list[PronySeries],
    strains_of: Callable[[list[int], list[PronySeries]], Sequence[WorkingPoint | NoSolutionError]],
    answers: _Results,
) -> dict[int, WorkingPoint]:
    """Working strains and frequencies; errors go to `answers`."""
    heard: dict[int, WorkingPoint] = {}
    for i, worked in zip(asked, strains_of(asked, series) if asked else (), strict=True):
        if isinstance(worked, NoSolutionError):
            answers[i] = worked
        else:
            heard[i] = positive_number("strain_of's strain", worked[0], "-"), worked[1]
    return heard


def _softening_factors(
    tasks: Sequence[StrainTask], asked: dict[int, tuple[float, float]], answers: _Results
) -> dict[int, tuple[float, float]]:
    """Factors of E' and E'' at ln strain and ω; errors of strains beyond the sweeps go to `answers`."""
    alike: dict[AmplitudeFactors, list[int]] = {}
    for i in asked:
        alike.setdefault(tasks[i].factors, []).append(i)
    found: dict[int, tuple[float, float]] = {}
    for factors, members in alike.items():
        together = [members]
        while together:
            chosen = together.pop()
            strain = np.exp([asked[i][0] for i in chosen])
            at = [tasks[i].temperature for i in chosen]
            try:
                pairs = zip(factors.storage(strain, at).tolist(), factors.loss(strain, at).tolist(), strict=True)
                found.update(zip(chosen, pairs, strict=True))
            except RangeError as error:
                if len(chosen) > 1:
                    together += [[i] for i in chosen]
                else:
                    answers[chosen[0]] = error
    return {i: _factors_beyond_sweeps(tasks[i], found[i], omega) for i, (_, omega) in asked.items() if i in found}


def _factors_beyond_sweeps(task: StrainTask, factors: tuple[float, float], omega: float) -> tuple[float, float]:
    """Factors that change each modulus at most by as much as at the nearest temperature swept."""
    if task.swept is None:
        return factors
    there, here = complex(task.swept.modulus(omega)), complex(task.series.modulus(omega))
    ratios = min(1.0, there.real / here.real), min(1.0, there.imag / here.imag)
    return 1.0 + ratios[0] * (factors[0] - 1.0), 1.0 + ratios[1] * (factors[1] - 1.0)


def _series_at_trials(
    tasks: Sequence[StrainTask], paths: dict[int, _StrainIteration], answers: _Results
) -> dict[int, tuple[PronySeries, tuple[float, float]]]:
    """Series at the trial strains, and their factors; errors go to `answers`."""
    factors = _softening_factors(tasks, {i: (path.trial, path.omega) for i, path in paths.items()}, answers)
    if not factors:
        return {}
    omegas = np.array([paths[i].omega for i in factors])
    made = _soften_many([tasks[i].series for i in factors], np.array(list(factors.values())), omegas)
    soft: dict[int, tuple[PronySeries, tuple[float, float]]] = {}
    for (i, pair), series in zip(factors.items(), made, strict=True):
        if isinstance(series, NoSolutionError):
            answers[i] = series
        else:
            soft[i] = series, pair
    return soft


class _StrainIteration:
    """Iteration of one working strain: ln of the first strain and of the trial, and the remaining change."""

    def __init__(self, strain: float, omega: float) -> None:
        self.first = self.trial = math.log(strain)
        self.omega, self.steps, self.left = omega, 1, math.inf
        self._slowing = omega
        self._before: tuple[float, float] | None = None
        self._change = 0.0

    def guess(self, stiff: float) -> None:
        """Set the trial from the factor of E' at the previous one."""
        self.trial = self.first - _STRAIN_EXPONENT * math.log(stiff)
        self.omega = self._slowing * stiff**_FREQUENCY_EXPONENT

    def next_step(self, strain: float, omega: float, stiff: float, ahead: float) -> None:
        """Step by secant, from strain and ω at a factor of E', and the factor at that strain."""
        self.steps += 1
        change = math.log(strain) - self.trial
        if self._before is not None and self.trial != self._before[0]:
            slope = (change - self._before[1]) / (self.trial - self._before[0])
        else:  # ln strain falls with ln E' as it did from the first step
            softens = (math.log(strain) - self.first) / -math.log(stiff) if stiff != 1.0 else _STRAIN_EXPONENT
            steep = math.log(ahead / stiff) / change if change != 0.0 else 0.0
            slope = -1.0 - softens * steep
        contracts = max(abs(1.0 + slope), _LEAST_CONTRACTION)
        self.left = max(contracts * abs(change), _LEAST_CONTRACTION * abs(math.log(omega / self.omega)))
        move = -change / slope if slope < 0.0 else 0.5 * change
        self._before, self._change, self.omega = (self.trial, change), change, omega
        self.trial += math.copysign(min(abs(move), _LARGEST_STEP), move)

    def no_convergence_error(self) -> NoSolutionError:
        """Error: the iteration does not converge."""
        return NoSolutionError(
            f"the working strain did not settle in {_MOST_STEPS} steps: last {math.exp(self.trial):.4g}, "
            f"changing by {abs(self._change):.2g} of itself; ask for a larger rtol, or smooth the strain sweeps "
            "(Kraus' law)"
        )
