"""Walks the route: the contact of every roll, and from it the forces of every stretch of both strands."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from conveyor.errors import NoSolutionError
from conveyor.indentation import (
    Indentation,
    IndentationCurve,
    RollContact,
    forgotten,
    indentation_curves,
)
from conveyor.laws.loading import RollLoad
from conveyor.laws.resistance import flexure_resistance
from conveyor.laws.softening import WorkingStrain, losing_load, softened_cover
from conveyor.line.stretches import FixedForces, Pressing, Strand, Stretch, roll_at, stretches
from conveyor.models import Conveyor, RubberCompound
from conveyor.rubber import AmplitudeFactors, PronySeries
from conveyor.units import si

Array = NDArray[np.float64]

_CURVE_DOWN_TO = 0.25  # of the highest load: a curve to be looked at, also where all rolls bear the same


@dataclass(frozen=True, eq=False)
class RollResult:
    """One roll of a set: its load and its indentation.

    Attributes
    ----------
    load : RollLoad
        Force and distribution.
    curve : IndentationCurve
        The load curve it was read from.
    resistance : float
        Indentation resistance of the roll, ∫ f(w(y)) dy along it [N].
    """

    load: RollLoad
    curve: IndentationCurve
    resistance: float

    @cached_property
    def peak(self) -> Indentation:
        """Contact at the highest line load, for a wing that of its inner end."""
        return self.curve.at(self.load.peak_line_load)


@dataclass(frozen=True)
class Surface:
    """What the rolls of a strand run on: thickness [m], rubber at its temperature, Poisson's ratio.

    `strain` is what the rubber was softened for; None where it is that of the master curve.
    """

    thickness: float
    rubber: PronySeries
    poisson: float
    strain: WorkingStrain | None = None


Surfaces = Mapping[Strand, Surface]


@dataclass(frozen=True, eq=False)
class StretchResult:
    """Forces of a stretch [N]; `unit_main` is the main resistance DIN 22101 gives for f = 1."""

    stretch: Stretch
    surface: Surface
    rolls: tuple[RollResult, ...]
    indentation: float
    rotation: float
    flexure: float
    tilt: float
    lift: float
    unit_main: float

    @property
    def main(self) -> float:
        """Indentation, rotation and flexure [N]."""
        return self.indentation + self.rotation + self.flexure

    @property
    def total(self) -> float:
        """All forces along the stretch [N]."""
        return self.main + self.tilt + self.lift


def excited_band(results: tuple[StretchResult, ...], strand: Strand) -> tuple[float, float] | None:
    """Frequencies between which every roll of a strand loses nine tenths of its energy [Hz]; None without loss."""
    low, high = slowest_excited(results, strand), fastest_excited(results, strand)
    return None if low is None or high is None else (low, high)


def worst_error(results: Iterable[StretchResult]) -> float:
    """Largest relative error estimate of any roll's indentation [-]."""
    return max(roll.curve.curve.error for result in results for roll in result.rolls)


def worst_energy_error(results: Iterable[StretchResult]) -> float:
    """Largest relative difference of any roll's friction by geometry and by loss [-]."""
    return max(roll.curve.curve.energy_error for result in results for roll in result.rolls)


def slowest_excited(results: tuple[StretchResult, ...], strand: Strand) -> float | None:
    """Lower end of the excited band [Hz]."""
    found = [curve.slowest_excited for curve in _curves(results, strand)]
    return min((f for f in found if f is not None), default=None)


def fastest_excited(results: tuple[StretchResult, ...], strand: Strand) -> float | None:
    """Upper end of the excited band [Hz]."""
    found = [curve.fastest_excited for curve in _curves(results, strand)]
    return max((f for f in found if f is not None), default=None)


def _curves(results: tuple[StretchResult, ...], strand: Strand) -> set[IndentationCurve]:
    return {roll.curve for r in results if r.stretch.strand == strand for roll in r.rolls}


def indented(
    tracks: Sequence[Track], covers: Sequence[Surfaces]
) -> list[tuple[StretchResult, ...] | NoSolutionError]:
    """Forces along the belt for many conveyors or many rubbers of one; all contacts are solved side by side.

    Parameters
    ----------
    tracks : sequence of Track
        One for each scene; scenes that differ in rubber and temperature only share theirs.
    covers : sequence of mapping
        What the rolls of each strand run on, for each scene.

    Returns
    -------
    list
        In their order the stretches' forces, or why a scene has none.
    """
    scenes = [_Scene(track, cover) for track, cover in zip(tracks, covers, strict=True)]
    jobs: dict[float, dict[RollContact, tuple[float, float]]] = {}
    for scene in scenes:
        _widen(jobs.setdefault(scene.track.rtol, {}), scene.loads)
    solved = {rtol: _solved(loads, rtol) for rtol, loads in jobs.items()}
    return [scene.results(solved[scene.track.rtol]) for scene in scenes]


def _widen(
    spans: dict[RollContact, tuple[float, float]], others: Mapping[RollContact, tuple[float, float]]
) -> None:
    """Ranges of load that hold the others', too."""
    for contact, (low, high) in others.items():
        known = spans.get(contact, (low, high))
        spans[contact] = min(low, known[0]), max(high, known[1])


def _solved(
    loads: Mapping[RollContact, tuple[float, float]], rtol: float
) -> dict[RollContact, IndentationCurve | NoSolutionError]:
    contacts = list(loads)
    lowest, highest = zip(*loads.values(), strict=True)
    return dict(zip(contacts, indentation_curves(contacts, lowest, highest, rtol), strict=True))


def surfaces(conveyor: Conveyor, temperature: float | None = None) -> dict[Strand, Surface]:
    """The cover under each strand, at the belt's temperature or another [K]; one series per compound.

    Raises
    ------
    RangeError
        A compound is not known at the belt's temperature.
    """
    temperature = si(conveyor.ambient.belt) if temperature is None else temperature
    carry, back = conveyor.carry_compound, conveyor.return_compound
    series = carry.series(temperature)
    same = back is carry or back == carry
    other = series if same else back.series(temperature)
    return {
        "carry": Surface(si(conveyor.belt.bottom_cover.thickness), series, carry.poisson_ratio),
        "return": Surface(si(conveyor.return_cover_thickness), other, back.poisson_ratio),
    }


def worked_surfaces(track: Track, covers: Surfaces, temperature: float) -> dict[Strand, Surface]:
    """The covers at the strain their rolls work them at, where the compounds' sweeps know them at a temperature [K].

    Raises
    ------
    NoSolutionError
        A cover has no answer at its working strain.
    RangeError
        A compound's sweeps do not reach the strain.
    """
    conveyor = track.conveyor
    if conveyor.calculation.strain == "off":
        return dict(covers)
    compounds: dict[Strand, RubberCompound] = {
        "carry": conveyor.carry_compound,
        "return": conveyor.return_compound,
    }
    return {
        strand: _worked(track, strand, cover, compounds[strand].strain_factors(temperature), temperature)
        for strand, cover in covers.items()
    }


def _worked(
    track: Track, strand: Strand, cover: Surface, factors: AmplitudeFactors | None, temperature: float
) -> Surface:
    if factors is None:
        return cover
    kinds = [kind for kind in track.kinds if kind.strand == strand]
    loads = np.concatenate([kind.line_loads for kind in kinds])
    weights = np.concatenate([kind.weights * kind.sets for kind in kinds])
    contact = _roll_contact(track, max(kinds, key=lambda kind: kind.highest), cover)
    series, strain = softened_cover(contact, losing_load(loads, weights), factors, temperature)
    return replace(cover, rubber=series, strain=strain)


def _roll_contact(track: Track, kind: _Kind, cover: Surface) -> RollContact:
    return RollContact(
        radius=kind.radius,
        spacing=kind.spacing,
        cover_thickness=cover.thickness,
        speed=track.speed,
        rubber=cover.rubber,
        poisson=cover.poisson,
        support=track.conveyor.calculation.support,
    )


@dataclass(frozen=True)
class _Kind:
    """Rolls of one radius and spacing on one strand: all their line loads in one array.

    `rolls` are (stretch, place), `starts` where each one's loads begin, `weights` the quadrature's along the roll,
    `sets` how many such sets there are; `line_loads` are `distinct[which]`, for sections that bear alike.
    """

    strand: Strand
    radius: float
    spacing: float
    rolls: tuple[tuple[int, int], ...]
    starts: NDArray[np.int_]
    line_loads: Array
    distinct: Array
    which: NDArray[np.intp]
    weights: Array
    sets: Array
    lowest: float
    highest: float


class Track:
    """A conveyor whose rolls' loads are known, and every force along the belt but the rubber's.

    Parameters
    ----------
    conveyor : Conveyor
        Its compounds and its temperature play no part.
    rtol : float, optional
        Relative tolerance of the contacts; the spec's without it [-].
    extra_mass : mapping of (section, strand) to float, optional
        With which tension presses on the rolls of a vertical curve [kg/m].
    """

    def __init__(
        self, conveyor: Conveyor, rtol: float | None = None, extra_mass: Pressing | None = None
    ) -> None:
        self.conveyor = conveyor
        self.rtol = conveyor.calculation.rtol if rtol is None else rtol
        self.speed = si(conveyor.belt.speed)
        self.flexure_share = si(conveyor.calculation.flexure_share)
        self.stretches = stretches(conveyor, extra_mass)
        self.kinds = _kinds(self.stretches, conveyor.calculation.gauss_points)
        gravity = si(conveyor.calculation.gravity)
        self.fixed = tuple(FixedForces.of(stretch, gravity) for stretch in self.stretches)


def _kinds(route: tuple[Stretch, ...], points: int) -> tuple[_Kind, ...]:
    """Rolls that share a contact, with the line loads that occur on them."""
    gathered: dict[tuple[Strand, float, float], list[tuple[int, int]]] = {}
    for i, stretch in enumerate(route):
        for place in range(len(stretch.loads)):
            radius = 0.5 * si(roll_at(stretch.idlers, place).diameter)
            gathered.setdefault((stretch.strand, radius, stretch.spacing), []).append((i, place))
    found = []
    for (strand, radius, spacing), rolls in gathered.items():
        loads = [route[i].loads[place] for i, place in rolls]
        sampled = [load.line_loads(points) for load in loads]
        lines = np.concatenate([w for w, _ in sampled])
        distinct, which = np.unique(lines, return_inverse=True)
        highest = max(float(lines.max()), *(load.peak_line_load for load in loads))
        found.append(
            _Kind(
                strand=strand,
                radius=radius,
                spacing=spacing,
                rolls=tuple(rolls),
                starts=np.cumsum([0, *(w.size for w, _ in sampled[:-1])]),
                line_loads=lines,
                distinct=distinct,
                which=which,
                weights=np.concatenate([weights for _, weights in sampled]),
                sets=np.concatenate(
                    [np.full(w.size, route[i].sets) for (i, _), (w, _) in zip(rolls, sampled, strict=True)]
                ),
                lowest=min(float(lines.min()), _CURVE_DOWN_TO * highest),
                highest=highest,
            )
        )
    return tuple(found)


class _Scene:
    """A track under one pair of covers: the contacts its rolls need, and the forces once they are solved."""

    def __init__(self, track: Track, covers: Surfaces) -> None:
        self.track, self.covers = track, covers
        contacts = [_roll_contact(track, kind, covers[kind.strand]) for kind in track.kinds]
        shared = forgotten(contacts, track.rtol)
        self.contacts = [shared[contact] for contact in contacts]
        self.loads: dict[RollContact, tuple[float, float]] = {}
        for contact, kind in zip(self.contacts, track.kinds, strict=True):
            _widen(self.loads, {contact: (kind.lowest, kind.highest)})

    def results(
        self, curves: Mapping[RollContact, IndentationCurve | NoSolutionError]
    ) -> tuple[StretchResult, ...] | NoSolutionError:
        """Forces of every stretch, or the first contact's error."""
        route = self.track.stretches
        rolls: list[list[RollResult | None]] = [[None] * len(stretch.loads) for stretch in route]
        together: dict[RollContact, list[_Kind]] = {}
        for contact, kind in zip(self.contacts, self.track.kinds, strict=True):
            together.setdefault(contact, []).append(kind)
        for contact, kinds in together.items():
            curve = curves[contact]
            if isinstance(curve, NoSolutionError):
                return curve
            drags = curve.resistance(np.concatenate([kind.distinct for kind in kinds]))
            starts = np.cumsum([0, *(kind.distinct.size for kind in kinds)])
            for kind, start in zip(kinds, starts.tolist(), strict=False):
                forces = np.add.reduceat(drags[start + kind.which] * kind.weights, kind.starts)
                for (i, place), force in zip(kind.rolls, forces.tolist(), strict=True):
                    rolls[i][place] = RollResult(route[i].loads[place], curve, force)
        return tuple(
            self._result(stretch, fixed, tuple(roll for roll in found if roll is not None))
            for stretch, fixed, found in zip(route, self.track.fixed, rolls, strict=True)
        )

    def _result(self, stretch: Stretch, fixed: FixedForces, rolls: tuple[RollResult, ...]) -> StretchResult:
        indentation = stretch.sets * math.fsum(roll.resistance for roll in rolls)
        return StretchResult(
            stretch=stretch,
            surface=self.covers[stretch.strand],
            rolls=rolls,
            indentation=indentation,
            rotation=fixed.rotation,
            flexure=flexure_resistance(indentation + fixed.rotation, share=self.track.flexure_share)
            if fixed.flexure is None
            else fixed.flexure,
            tilt=fixed.tilt,
            lift=fixed.lift,
            unit_main=fixed.unit_main,
        )
