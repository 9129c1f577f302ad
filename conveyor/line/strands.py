"""Both strands of a line under load; shared by lines that differ in air, rubber or drives alone."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from conveyor.line.roll_kinds import RollKind, roll_kinds
from conveyor.line.stretches import (
    STRANDS,
    CurveLoads,
    RouteSection,
    Strand,
    Stretch,
    route_sections,
    strand_stretches,
)
from conveyor.models import Conveyor
from conveyor.units import si

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class LoopShape:
    """The stretches in the order the belt meets them from the head: return strand, then carry strand.

    Arrays of shape (2n,), except `way`: distance from the head to each boundary [m], shape (2n + 1,). `mass` is that
    of belt, bulk and rolls [kg], the rolls' reduced to their rims if given, else whole, on the safe side; `least` the
    least tension for the sag [N].
    """

    stretches: tuple[Stretch, ...]
    length: Array
    mass: Array
    least: Array
    way: Array


@dataclass(frozen=True, eq=False)
class OneStrand:
    """One strand of a line, SI.

    Attributes
    ----------
    strand : {"carry", "return"}
        The strand.
    stretches : tuple of Stretch
        Stretches in running direction.
    first : int
        Number of its first stretch among those of both strands.
    gravity : float
        Gravity at the site [m/s²].
    gauss_points : int
        Points of the quadrature along a roll.
    """

    strand: Strand
    stretches: tuple[Stretch, ...]
    first: int
    gravity: float
    gauss_points: int

    @classmethod
    def of(
        cls, conveyor: Conveyor, sections: tuple[RouteSection, ...], strand: Strand, acting: CurveLoads
    ) -> OneStrand:
        """Return one strand of a conveyor under the loads of tension on curves.

        Raises
        ------
        NoSolutionError
            As `Strands.of`.
        """
        along = strand_stretches(conveyor, sections, strand, acting)
        first, calculation = 0 if strand == "carry" else len(sections), conveyor.calculation
        return cls(strand, along, first, si(calculation.gravity), calculation.gauss_points)

    @property
    def flexes(self) -> bool:
        """True if the flexure of every span is computed, not a share of the main resistance."""
        return self.stretches[0].span_flexure is not None

    @cached_property
    def distinct_sets(self) -> tuple[list[tuple[float, ...]], list[int | None]]:
        """Distinct loads of the rolls of one set [N], and the index of every stretch's among them; None without."""
        borne = [tuple(load.force for load in s.loads) for s in self.stretches]
        numbers = {each: i for i, each in enumerate(dict.fromkeys(filter(None, borne)))}
        return list(numbers), [numbers.get(each) for each in borne]

    @cached_property
    def kinds(self) -> tuple[RollKind, ...]:
        """Rolls by the contact they share."""
        return roll_kinds(self.stretches, self.gauss_points, self.first)


@dataclass(frozen=True, eq=False)
class Strands:
    """Both strands of a line, SI.

    Attributes
    ----------
    sections : tuple of RouteSection
        Sections from the tail.
    each : tuple of OneStrand
        Carry strand from the tail, return strand from the head.
    """

    sections: tuple[RouteSection, ...]
    each: tuple[OneStrand, OneStrand]

    @classmethod
    def of(cls, conveyor: Conveyor, acting: CurveLoads | None = None) -> Strands:
        """Return the strands of a conveyor.

        Parameters
        ----------
        conveyor : Conveyor
            Its belt, idlers, material, route and calculation.
        acting : CurveLoads, optional
            Loads of tension on curves.

        Raises
        ------
        NoSolutionError
            The belt lifts off on a concave curve, or runs off its rolls on a horizontal one.
        """
        sections, on_curves = route_sections(conveyor), acting or CurveLoads()
        carry, back = (OneStrand.of(conveyor, sections, strand, on_curves) for strand in STRANDS)
        return cls(sections, (carry, back))

    @cached_property
    def stretches(self) -> tuple[Stretch, ...]:
        """Carry strand from the tail, then return strand from the head: 2n of n sections."""
        carry, back = self.each
        return (*carry.stretches, *back.stretches)

    @cached_property
    def kinds(self) -> tuple[RollKind, ...]:
        """Rolls by the contact they share."""
        carry, back = self.each
        return (*carry.kinds, *back.kinds)

    @cached_property
    def loop(self) -> LoopShape:
        """The stretches as the belt meets them from the head."""
        stretches = loop_order(self.stretches)
        length = np.array([s.length for s in stretches])
        moving = [s.line_mass + s.rim_mass / s.spacing for s in stretches]
        return LoopShape(
            stretches=stretches,
            length=length,
            mass=length * np.array(moving),
            least=np.array([s.least_tension for s in stretches]),
            way=np.concatenate([[0.0], np.cumsum(length)]),
        )


def loop_order(along: tuple[Stretch, ...]) -> tuple[Stretch, ...]:
    """Reorder carry and return strand as the belt meets them from the head: return, carry."""
    half = len(along) // 2
    return (*along[half:], *along[:half])
