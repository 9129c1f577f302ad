"""Contacts of the rolls on their covers; those of many lines are solved in one batch."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from conveyor.errors import NoSolutionError
from conveyor.indentation import (
    Indentation,
    IndentationCurve,
    RollContact,
    curve_resistances,
    indentation_curves,
    merge_equal_contacts,
)
from conveyor.indentation.softening import loss_weighted_load
from conveyor.laws.loading import RollLoad
from conveyor.line.covers import Covers, roll_contact
from conveyor.line.known_test_factors import TEST_FACTORS
from conveyor.line.line import Line
from conveyor.line.roll_kinds import RollKind
from conveyor.line.stretches import Strand

Array = NDArray[np.float64]
LoadRanges = Mapping[RollContact, tuple[float, float]]
"""Range of line loads of each contact [N/m]."""
LoadCurveCache: TypeAlias = dict[tuple[RollContact, float, float, float], IndentationCurve | NoSolutionError]
"""Curves by contact, range of line loads [N/m] and relative tolerance [-], the last used at the end."""


@dataclass(frozen=True, eq=False)
class PeakContacts:
    """Contacts of all rolls of one load curve at the highest line load of each [N/m], computed together."""

    curve: IndentationCurve
    loads: Array

    @cached_property
    def every(self) -> tuple[Indentation, ...]:
        """Contact of each roll."""
        return self.curve.at(self.loads).each


@dataclass(frozen=True, eq=False)
class RollResult:
    """One loaded roll of a set: its load and its indentation.

    Attributes
    ----------
    place : int
        Number of the roll in its set, from the left.
    load : RollLoad
        Force and distribution.
    curve : IndentationCurve
        Its load curve.
    resistance : float
        Indentation resistance of the roll, ∫ f(w(y)) dy along it [N].
    rigid_curve : IndentationCurve, optional
        Load curve on a rigid carcass, where that of `curve` yields.
    beside : (PeakContacts, int), optional
        Contacts of all rolls of the curve, and the number of this one.
    """

    place: int
    load: RollLoad
    curve: IndentationCurve
    resistance: float
    rigid_curve: IndentationCurve | None = None
    beside: tuple[PeakContacts, int] | None = None

    @cached_property
    def peak(self) -> Indentation:
        """Contact at the highest line load; on a wing roll at its inner end."""
        if self.beside is None:
            return self.curve.at(self.load.peak_line_load)
        contacts, i = self.beside
        return contacts.every[i]

    @property
    def cover_penetration(self) -> float:
        """Penetration of the cover alone at the highest line load, without the carcass's deflection [m]."""
        if self.rigid_curve is None:
            return float(self.peak.penetration)
        return float(self.rigid_curve.penetration(self.load.peak_line_load))


@dataclass(frozen=True, eq=False)
class Contacts:
    """Contacts of all rolls of a line, by load curve.

    Attributes
    ----------
    line : Line
        The conveyor.
    covers : mapping of strand to CoverState
        Cover under each strand.
    curves : tuple of IndentationCurve
        Theoretical load curve of every kind of roll, `line.kinds`.
    roll_indentation : tuple of ndarray
        Indentation resistance of every roll of a kind [N], in the order of `kind.rolls`, with the test factor.
    """

    line: Line
    covers: Covers
    curves: tuple[IndentationCurve, ...]
    roll_indentation: tuple[Array, ...]

    @cached_property
    def indentation(self) -> Array:
        """Indentation resistance of every stretch [N], shape (2n,)."""
        force = np.zeros(len(self.line.stretches))
        for kind, resistances in zip(self.line.kinds, self.roll_indentation, strict=True):
            np.add.at(force, [i for i, _ in kind.rolls], resistances)
        sets = np.array([stretch.sets for stretch in self.line.stretches])
        return np.asarray(force * sets)

    @cached_property
    def rolls(self) -> tuple[tuple[RollResult, ...], ...]:
        """The loaded rolls of one set of every stretch, left to right."""
        stretches = self.line.stretches
        by_position: list[dict[int, RollResult]] = [{} for _ in stretches]
        for kind, curve, resistances in zip(self.line.kinds, self.curves, self.roll_indentation, strict=True):
            loads = [stretches[i].loads[place] for i, place in kind.rolls]
            peaks = PeakContacts(curve, np.array([load.peak_line_load for load in loads]))
            for n, ((i, place), load, force) in enumerate(zip(kind.rolls, loads, resistances.tolist(), strict=True)):
                by_position[i][place] = RollResult(place, load, curve, force, beside=(peaks, n))
        return tuple(tuple(rolls[place] for place in sorted(rolls)) for rolls in by_position)

    def curves_of(self, strand: Strand) -> tuple[IndentationCurve, ...]:
        """Load curves of a strand's rolls."""
        pairs = zip(self.line.kinds, self.curves, strict=True)
        return tuple(dict.fromkeys(curve for kind, curve in pairs if kind.strand == strand))

    def lossy(self, strand: Strand) -> bool:
        """True if any roll of a strand loses energy in its cover."""
        return any(curve.lossy for curve in self.curves_of(strand))

    def excited_band(self, strand: Strand) -> tuple[float, float] | None:
        """Frequency band of nine tenths of the energy loss of every roll of a strand [Hz]; None without loss."""
        low, high = self.slowest_excited(strand), self.fastest_excited(strand)
        return None if low is None or high is None else (low, high)

    def slowest_excited(self, strand: Strand) -> float | None:
        """Lower end of the excited band [Hz]."""
        return min((f for one in self.curves_of(strand) if (f := one.slowest_excited) is not None), default=None)

    def fastest_excited(self, strand: Strand) -> float | None:
        """Upper end of the excited band [Hz]."""
        return max((f for one in self.curves_of(strand) if (f := one.fastest_excited) is not None), default=None)

    def rolls_on(self, strand: str) -> bool:
        """True if a strand runs on rolls anywhere, not on plates alone."""
        return any(kind.strand == strand for kind in self.line.kinds)

    def losing_load(self, strand: Strand) -> float:
        """Mean line load of a strand's rolls, weighted by energy loss [N/m]; 0 without rolls."""
        kinds = [kind for kind in self.line.kinds if kind.strand == strand]
        if not kinds:
            return 0.0
        loads = np.concatenate([kind.line_loads for kind in kinds])
        return loss_weighted_load(loads, np.concatenate([kind.weights * kind.sets for kind in kinds]))

    def test_factor(self, strand: Strand) -> float:
        """Test factor on a strand's indentation at its mean line load [-]; 1 without tests."""
        tested = self.covers[strand].test_factor
        return 1.0 if tested is None or not self.rolls_on(strand) else float(tested.factor(self.losing_load(strand)))

    def test_factor_band(self, strand: Strand) -> float:
        """Half-width of the 90 % band of the logarithm of the test factor [-]; 0 without tests."""
        tested = self.covers[strand].test_factor
        if tested is None or not self.rolls_on(strand):
            return 0.0
        return tested.rolling_tests.band(self.losing_load(strand), tested.temperature)

    def test_factor_range(self, strand: Strand, *, own: bool = False) -> tuple[float, float]:
        """90 % range of the factor on a strand's indentation [-]; 1 and 1 without tests.

        It combines the band of the tests with, beyond the tested temperatures, that of the compound's replicas.

        Parameters
        ----------
        strand : {"carry", "return"}
            The strand.
        own : bool
            Leave out the error that tests of one series share, as for comparing two compounds.

        Raises
        ------
        NoSolutionError
            A replica's contact has no answer.
        """
        tested = self.covers[strand].test_factor
        if tested is None or not self.rolls_on(strand):
            return 1.0, 1.0
        half = tested.rolling_tests.own_half_width if own else self.test_factor_band(strand)
        if tested.rolling_tests.tested_at(tested.temperature):
            return math.exp(-half), math.exp(half)
        heaviest = max((kind for kind in self.line.kinds if kind.strand == strand), key=lambda kind: kind.highest)
        contact, load = roll_contact(self.line, heaviest, self.covers[strand]), self.losing_load(strand)
        temperatures = tested.temperature, tested.rolling_tests.nearest(tested.temperature)
        ends = TEST_FACTORS.replica_band(tested.compound, contact, load, temperatures)
        low, high = (math.hypot(half, end) for end in ends)
        return math.exp(-low), math.exp(high)

    def deepest(self, strand: Strand) -> float:
        """Largest penetration of a strand's rolls over the thickness of their cover [-]; 0 without rolls."""
        highest: dict[IndentationCurve, float] = {}
        for kind, curve in zip(self.line.kinds, self.curves, strict=True):
            if kind.strand == strand:
                highest[curve] = max(kind.highest, highest.get(curve, 0.0))
        depths = [float(curve.penetration(load)) for curve, load in highest.items()]
        return max(depths, default=0.0) / self.covers[strand].thickness

    @property
    def error(self) -> float:
        """Largest relative error estimate of any roll's indentation [-]."""
        pairs = zip(self.line.kinds, self.curves, strict=True)
        return max(curve.error + self.covers[kind.strand].indentation_error for kind, curve in pairs)

    @property
    def energy_error(self) -> float:
        """Largest relative difference of any roll's friction by geometry and by loss [-]."""
        return max(curve.energy_error for curve in self.curves)


def solve_contacts(
    lines: Sequence[Line], covers: Sequence[Covers], rtol: float | None, known: LoadCurveCache
) -> list[Contacts | NoSolutionError]:
    """Solve the contacts of many lines, or of many rubbers under one, in one batch.

    Parameters
    ----------
    lines : sequence of Line
        One for each case; cases that differ in rubber and temperature only share their line.
    covers : sequence of mapping
        Cover under each strand, for each case.
    rtol : float or None
        Relative tolerance of the contacts [-]; that of each line without it.
    known : dict
        Curves of earlier calls; new ones are added.

    Returns
    -------
    list
        Contacts in the order of the cases, or the error.
    """
    tolerances = [
        (line.rtol if rtol is None else rtol) - max(cover.indentation_error for cover in own.values())
        for line, own in zip(lines, covers, strict=True)
    ]
    asked = [_roll_contacts(*scene) for scene in zip(lines, covers, tolerances, strict=True)]
    jobs: dict[float, dict[RollContact, tuple[float, float]]] = {}
    for line, contacts, tolerance in zip(lines, asked, tolerances, strict=True):
        spans = jobs.setdefault(tolerance, {})
        for contact, kind in zip(contacts, line.kinds, strict=True):
            low, high = spans.get(contact, (kind.lowest, kind.highest))
            spans[contact] = min(low, kind.lowest), max(high, kind.highest)
    solved = {tolerance: _solve_load_curves(spans, tolerance, known) for tolerance, spans in jobs.items()}
    curves = [
        _curves_or_error([solved[tolerance][contact] for contact in contacts])
        for contacts, tolerance in zip(asked, tolerances, strict=True)
    ]
    return _read_contacts(lines, covers, curves)


def _roll_contacts(line: Line, covers: Covers, rtol: float) -> list[RollContact]:
    """Contact of every kind of roll; those that differ in a spacing without influence are one."""
    contacts = [roll_contact(line, kind, covers[kind.strand]) for kind in line.kinds]
    shared = merge_equal_contacts(contacts, rtol)
    return [shared[contact] for contact in contacts]


def _solve_load_curves(
    spans: LoadRanges, rtol: float, known: LoadCurveCache
) -> dict[RollContact, IndentationCurve | NoSolutionError]:
    """Curves of all contacts: known ones reused, the others solved in one batch."""
    keys = {contact: (contact, *span, rtol) for contact, span in spans.items()}
    solved = {contact: one for contact, key in keys.items() if (one := known.pop(key, None)) is not None}
    if new := [contact for contact in spans if contact not in solved]:
        lowest, highest = zip(*(spans[contact] for contact in new), strict=True)
        solved |= zip(new, indentation_curves(new, lowest, highest, rtol), strict=True)
    known |= {key: solved[contact] for contact, key in keys.items()}
    return solved


def _curves_or_error(
    solved: Sequence[IndentationCurve | NoSolutionError],
) -> tuple[IndentationCurve, ...] | NoSolutionError:
    """Curves of a line's rolls, or the first error."""
    refused = next((one for one in solved if isinstance(one, NoSolutionError)), None)
    return refused or tuple(one for one in solved if isinstance(one, IndentationCurve))


def _read_contacts(
    lines: Sequence[Line],
    covers: Sequence[Covers],
    curves: Sequence[tuple[IndentationCurve, ...] | NoSolutionError],
) -> list[Contacts | NoSolutionError]:
    """Resistance of every roll from the load curves of all lines."""
    asked: dict[IndentationCurve, list[tuple[int, int]]] = {}
    for i, own in enumerate(curves):
        for k, curve in enumerate(own if isinstance(own, tuple) else ()):
            asked.setdefault(curve, []).append((i, k))
    loads = [[lines[i].kinds[k].distinct for i, k in members] for members in asked.values()]
    resistances: list[dict[int, Array]] = [{} for _ in lines]
    whole = curve_resistances(list(asked), [np.concatenate(each) for each in loads])
    for members, each, resistance in zip(asked.values(), loads, whole, strict=True):
        parts = np.split(resistance, np.cumsum([distinct.size for distinct in each])[:-1])
        for (i, k), part in zip(members, parts, strict=True):
            kind = lines[i].kinds[k]
            tested = covers[i][kind.strand].test_factor
            scaled = part if tested is None else part * tested.factor(kind.distinct)
            resistances[i][k] = integrate_along_rolls(kind, scaled[kind.which])
    return [
        Contacts(line, cover, own, tuple(found[k] for k in range(len(own)))) if isinstance(own, tuple) else own
        for line, cover, own, found in zip(lines, covers, curves, resistances, strict=True)
    ]


def integrate_along_rolls(kind: RollKind, resistance: Array) -> Array:
    """Integrate the resistance per width at every line load [N/m] along each roll [N]."""
    return np.asarray(np.add.reduceat(resistance * kind.weights, kind.starts))
