"""Linear viscoelastic solids as discrete spectra: relaxation form (Prony series) and creep form."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from conveyor.arguments.arrays import (
    ComplexArray,
    FloatArray,
    non_negative_array,
    positive_number,
    sorted_spectrum,
)
from conveyor.rubber.spectrum_inversion import invert_spectrum

_FLUID_ADVICE = (
    ": without an equilibrium modulus the series is a fluid and the belt would creep without end;"
    " fit again with the equilibrium modulus held at a measured value"
)

_SPECTRA_AT_ONCE: Final = 16  # spectra inverted at once: few enough for the cache


def _debye_functions(omega: ArrayLike, times: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """x^2/(1+x^2), x/(1+x^2), 1/(1+x^2) of x = omega*times, on a new last axis, without overflow."""
    x = non_negative_array("omega", omega, "rad/s")[..., None] * times
    h = np.hypot(1.0, x)
    cosine, sine = 1.0 / h, x / h
    return sine * sine, sine * cosine, cosine * cosine


def _merge_equal_times(weights: FloatArray, times: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Merge terms of equal time, which a pole within 1e-16 of a root of the others leaves."""
    distinct, index = np.unique(times, return_inverse=True)
    return np.bincount(index, weights, distinct.size).astype(np.float64, copy=False), distinct


@dataclass(frozen=True, eq=False)
class PronySeries:
    r"""Relaxation modulus ``E(t) = E_e + sum_i E_i exp(-t/tau_i)`` (generalised Maxwell model).

    Parameters
    ----------
    equilibrium : float
        Equilibrium (rubbery, zero-frequency) modulus E_e, > 0 [Pa].
    moduli : array_like
        Moduli E_i, shape `(n,)`, > 0; n = 0 is an elastic solid [Pa].
    times : array_like
        Relaxation times tau_i, shape `(n,)`, > 0, distinct; sorted ascending with their moduli [s].

    Raises
    ------
    InputError
        If a number is not finite and > 0, lengths differ, times repeat, or E_e = 0 (a fluid).

    Notes
    -----
    Small strain, isothermal, at the temperature the times hold for. Frequencies are ANGULAR:
    omega = 2 pi f; times and frequencies that are negative or not finite are refused (InputError). The arrays are
    read-only; two series are equal only if they are the same object.

    References
    ----------
    J. D. Ferry, Viscoelastic Properties of Polymers, 3rd ed. (1980), chapter 3, Eqs. (22)-(29).

    Examples
    --------
    >>> series = PronySeries(equilibrium=1e6, moduli=[9e6], times=[1e-3])
    >>> round(float(series.storage(1e3))), round(float(series.loss(1e3)))
    (5500000, 4500000)
    >>> print(series.creep())
    CreepSeries(instantaneous=1e-07, compliances=array([9.e-07]), times=array([0.01]))
    """

    equilibrium: float
    moduli: FloatArray
    times: FloatArray

    def __post_init__(self) -> None:
        """Check, copy, sort, freeze."""
        moduli, times = sorted_spectrum("moduli", self.moduli, "Pa", self.times)
        object.__setattr__(self, "equilibrium", positive_number("equilibrium", self.equilibrium, "Pa", _FLUID_ADVICE))
        object.__setattr__(self, "moduli", moduli)
        object.__setattr__(self, "times", times)

    def _repr_html_(self) -> str:
        """For notebooks: moduli and times, the terms folded away."""
        from conveyor.text.markup import name_value_table

        terms = [
            {"modulus [MPa]": f"{modulus / 1e6:.6g}", "relaxation time [s]": f"{time:.6g}"}
            for modulus, time in zip(self.moduli, self.times, strict=True)
        ]
        rows = [
            ("equilibrium modulus", f"{self.equilibrium / 1e6:.6g} MPa"),
            ("glassy modulus", f"{self.glassy / 1e6:.6g} MPa"),
            ("terms", terms or "none: an elastic solid"),
        ]
        return str(name_value_table("PronySeries", rows))

    @property
    def glassy(self) -> float:
        """Instantaneous modulus ``E_inf = E_e + sum E_i`` [Pa]."""
        return float(self.equilibrium + self.moduli.sum())

    def relaxation(self, t: ArrayLike) -> FloatArray:
        """Relaxation modulus E(t) after a step of strain.

        Parameters
        ----------
        t : array_like
            Time since the step, >= 0, any shape [s].

        Returns
        -------
        numpy.ndarray
            E(t), shape of `t` [Pa].
        """
        decay = np.exp(-non_negative_array("t", t, "s")[..., None] / self.times)
        return np.asarray(self.equilibrium + decay @ self.moduli)[()]

    def storage(self, omega: ArrayLike) -> FloatArray:
        """Storage modulus ``E' = E_e + sum E_i x^2/(1+x^2)``, x = omega tau_i.

        Parameters
        ----------
        omega : array_like
            Angular frequency 2 pi f, >= 0, any shape [rad/s].

        Returns
        -------
        numpy.ndarray
            E', shape of `omega` [Pa].
        """
        return np.asarray(self.equilibrium + _debye_functions(omega, self.times)[0] @ self.moduli)[()]

    def loss(self, omega: ArrayLike) -> FloatArray:
        """Loss modulus ``E'' = sum E_i x/(1+x^2)``, x = omega tau_i.

        Parameters
        ----------
        omega : array_like
            Angular frequency 2 pi f, >= 0, any shape [rad/s].

        Returns
        -------
        numpy.ndarray
            E'', shape of `omega` [Pa].
        """
        return np.asarray(_debye_functions(omega, self.times)[1] @ self.moduli)[()]

    def tan_delta(self, omega: ArrayLike) -> FloatArray:
        """Loss tangent E''/E'.

        Parameters
        ----------
        omega : array_like
            Angular frequency 2 pi f, >= 0, any shape [rad/s].

        Returns
        -------
        numpy.ndarray
            tan delta, shape of `omega` [-].
        """
        modulus = self.modulus(omega)
        return np.asarray(modulus.imag / modulus.real)[()]

    def modulus(self, omega: ArrayLike) -> ComplexArray:
        """Complex modulus ``E* = E' + i E''`` for strain ~ exp(+i omega t).

        Parameters
        ----------
        omega : array_like
            Angular frequency 2 pi f, >= 0, any shape [rad/s].

        Returns
        -------
        numpy.ndarray
            E*, complex, shape of `omega` [Pa].
        """
        storage, loss, _ = _debye_functions(omega, self.times)
        return np.asarray(self.equilibrium + storage @ self.moduli + 1j * (loss @ self.moduli))[()]

    def creep(self) -> CreepSeries:
        """Convert exactly to the creep form, ``J*(omega) E*(omega) = 1`` at every frequency.

        Returns
        -------
        CreepSeries
            Each retardation time lies between consecutive relaxation times; as many terms as here (fewer only
            if two of them agree in every digit).

        Raises
        ------
        NoSolutionError
            If the moduli are beyond the range of double precision.

        Notes
        -----
        J*E* = 1 to 1e-14 for times over 24 decades, moduli over 24 decades and 60 terms. See `invert_spectrum`.
        """
        return creep_forms([self])[0]

    def scaled(self, *, a_T: float = 1.0, b_T: float = 1.0) -> PronySeries:
        """Shift to another temperature: times times `a_T`, all moduli times `b_T`.

        Parameters
        ----------
        a_T : float
            Horizontal shift factor, > 1 when colder than the reference [-].
        b_T : float
            Vertical shift factor of every modulus [-].

        Returns
        -------
        PronySeries
            The shifted series.

        Raises
        ------
        InputError
            If a factor is not finite and > 0.
        """
        a, b = positive_number("a_T", a_T, "-"), positive_number("b_T", b_T, "-")
        return PronySeries(self.equilibrium * b, self.moduli * b, self.times * a)

    def merged(self, *, fastest: float, slowest: float) -> PronySeries:
        """Merge the terms faster than one time into one term, and those slower than another.

        Parameters
        ----------
        fastest, slowest : float
            Terms between these times stay as they are [s].

        Returns
        -------
        PronySeries
            Same rubbery and glassy modulus. The fast term has their sum of moduli times times, so that E'' is kept to
            first order in ωτ; the slow one their sum of moduli over times, E'' to first order in 1/ωτ.
        """
        first, last = np.searchsorted(self.times, (fastest, slowest)).tolist()
        fast, slow = slice(0, first), slice(last, None)
        if first >= last or max(first, self.times.size - last) < 2:
            return self
        moduli, times = [self.moduli[first:last]], [self.times[first:last]]
        for part, power in ((fast, 1.0), (slow, -1.0)):
            if (whole := self.moduli[part].sum()) > 0.0:
                mean = self.moduli[part] @ self.times[part] ** power / whole
                moduli.append(np.array([whole]))
                times.append(np.array([mean**power]))
        return PronySeries(self.equilibrium, np.concatenate(moduli), np.concatenate(times))


@dataclass(frozen=True, eq=False)
class CreepSeries:
    r"""Creep compliance ``J(t) = J_inf + sum_i J_i (1 - exp(-t/lambda_i))`` (generalised Kelvin-Voigt model).

    Parameters
    ----------
    instantaneous : float
        Instantaneous (glassy) compliance J_inf = 1/E_inf, > 0 [1/Pa].
    compliances : array_like
        Compliances J_i, shape `(n,)`, > 0 [1/Pa].
    times : array_like
        Retardation times lambda_i, shape `(n,)`, > 0, distinct; sorted ascending [s].

    Raises
    ------
    InputError
        If a number is not finite and > 0, lengths differ or times repeat; of its functions, if a time or frequency is
        negative or not finite.

    Examples
    --------
    >>> creep = CreepSeries(instantaneous=1e-7, compliances=[9e-7], times=[1e-2])
    >>> print(creep.relaxation())
    PronySeries(equilibrium=1000000.0, moduli=array([9000000.]), times=array([0.001]))
    """

    instantaneous: float
    compliances: FloatArray
    times: FloatArray

    def __post_init__(self) -> None:
        """Check, copy, sort, freeze."""
        compliances, times = sorted_spectrum("compliances", self.compliances, "1/Pa", self.times)
        object.__setattr__(self, "instantaneous", positive_number("instantaneous", self.instantaneous, "1/Pa"))
        object.__setattr__(self, "compliances", compliances)
        object.__setattr__(self, "times", times)

    @property
    def equilibrium(self) -> float:
        """Compliance after infinite time, ``J_0 = J_inf + sum J_i = 1/E_e`` [1/Pa]."""
        return float(self.instantaneous + self.compliances.sum())

    def creep(self, t: ArrayLike) -> FloatArray:
        """Creep compliance J(t) after a step of stress.

        Parameters
        ----------
        t : array_like
            Time since the step, >= 0, any shape [s].

        Returns
        -------
        numpy.ndarray
            J(t), shape of `t` [1/Pa].
        """
        rise = -np.expm1(-non_negative_array("t", t, "s")[..., None] / self.times)
        return np.asarray(self.instantaneous + rise @ self.compliances)[()]

    def compliance(self, omega: ArrayLike) -> ComplexArray:
        """Complex compliance ``J* = J_inf + sum J_i/(1 + i omega lambda_i)``, strain ~ exp(+i omega t).

        Parameters
        ----------
        omega : array_like
            Angular frequency 2 pi f, >= 0, any shape [rad/s].

        Returns
        -------
        numpy.ndarray
            J*, complex with imaginary part <= 0, shape of `omega` [1/Pa].
        """
        _, loss, storage = _debye_functions(omega, self.times)
        return np.asarray(self.instantaneous + storage @ self.compliances - 1j * (loss @ self.compliances))[()]

    def relaxation(self) -> PronySeries:
        """Convert exactly to the relaxation form, the inverse of `PronySeries.creep`.

        Returns
        -------
        PronySeries
            Same number of terms, equilibrium modulus ``1/(J_inf + sum J_i)``.

        Raises
        ------
        NoSolutionError
            If the compliances are beyond the range of double precision.
        """
        excess, moduli = invert_spectrum(self.instantaneous, self.compliances, self.times, reciprocal=True)
        return PronySeries(1.0 / self.equilibrium, *_merge_equal_times(moduli, self.times[::-1] / (1.0 + excess)))


def creep_forms(series: Iterable[PronySeries]) -> list[CreepSeries]:
    """Convert many series to creep form, as `PronySeries.creep`; a repeated series is converted once.

    Parameters
    ----------
    series : iterable of PronySeries
        Series.

    Returns
    -------
    list of CreepSeries
        In their order.

    Raises
    ------
    NoSolutionError
        The moduli of one are beyond the range of double precision.
    """
    given = list(series)
    alike: dict[int, list[PronySeries]] = {}
    for one in dict.fromkeys(given):
        alike.setdefault(one.times.size, []).append(one)
    creep_of: dict[PronySeries, CreepSeries] = {}
    for same in alike.values():
        for start in range(0, len(same), _SPECTRA_AT_ONCE):
            chosen = same[start : start + _SPECTRA_AT_ONCE]
            moduli, times = (np.stack(part) for part in zip(*((s.moduli, s.times) for s in chosen), strict=True))
            excess, compliances = invert_spectrum([s.equilibrium for s in chosen], moduli, times)
            for one, over, weights in zip(chosen, excess, compliances, strict=True):
                terms = _merge_equal_times(weights, one.times * (1.0 + over))
                creep_of[one] = CreepSeries(1.0 / one.glassy, *terms)
    return [creep_of[one] for one in given]
