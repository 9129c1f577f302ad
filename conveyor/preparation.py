"""From specs to lines whose rolls are loaded, and to their covers at working strain."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

from conveyor.calculated_conveyor import CalculatedConveyor, NoAnswer, Variant
from conveyor.errors import InputError, NoSolutionError, RangeError
from conveyor.forces import RubberFreeForces, strand_rubber_free_forces
from conveyor.line.belt_contacts import TensionedCurveCache
from conveyor.line.contacts import LoadCurveCache
from conveyor.line.covers import (
    STRAIN_INTERPOLATION_RTOL,
    TERM_MERGE_SHARE,
    CoverLoading,
    Covers,
    CoverState,
    CoverTestFactor,
    compounds_by_strand,
    cover_series,
    covers_by_strand,
    resolved_time_range,
    softened_covers,
)
from conveyor.line.known_test_factors import TEST_FACTORS, TestFactorAnswer
from conveyor.line.line import Line
from conveyor.line.roll_drags import roll_drags_many
from conveyor.line.strands import OneStrand, Strands
from conveyor.line.stretches import STRANDS, CurveLoads, RouteSection, Strand, route_sections
from conveyor.loop.loop_layout import LoopLayout
from conveyor.models import Calculation, Conveyor, RubberCompound
from conveyor.reuse import ReuseCache, part_key


@dataclass(frozen=True, eq=False)
class PreparedLine:
    """A line prepared for its contacts: loop, forces independent of rubber, loaded covers.

    `has_curve_loads`: with loads of tension on curves, so that no other variant shares it; `uses_rolling_tests`: test
    factors apply.
    """

    line: Line
    layout: LoopLayout
    rubber_free: RubberFreeForces
    has_curve_loads: bool
    cover_loadings: Mapping[Strand, CoverLoading] = field(default_factory=dict)
    uses_rolling_tests: bool = False


class Preparation:
    """Lines of the variants of one call and their covers, parts that variants share made once."""

    def __init__(
        self,
        kept: ReuseCache,
        rtol: float | None = None,
        runs: Iterable[Iterable[int]] = (),
        known: CalculatedConveyor | None = None,
    ) -> None:
        kept.begin()
        self._kept, self._own, self._rtol = kept, ReuseCache(), rtol
        self._softened: dict[CoverLoading, CoverState | NoAnswer] = {}
        self.curves: LoadCurveCache = kept.curves
        self.tensioned: TensionedCurveCache = {}
        interpolates = rtol is not None and rtol >= STRAIN_INTERPOLATION_RTOL
        self._runs = [list(run) for run in runs] if interpolates else []
        if known is not None:
            self._reuse_covers(known)

    def _reuse_covers(self, known: CalculatedConveyor) -> None:
        """Take over the covers of a calculated variant at their working strain."""
        for strand, compound in compounds_by_strand(known.conveyor).items():
            cover = known.contacts.covers[strand]
            work = CoverLoading(known.line, strand, cover, compound, known.temperature)
            self._softened[self._kept.first(work, "alike", (compound,), work.key)] = cover

    def solve_test_factors(self, variants: Iterable[Variant]) -> None:
        """Solve the unknown test factors of all compounds side by side."""
        tested = [one.conveyor for one in variants if _uses_rolling_tests(one.conveyor.calculation)]
        for softened in (True, False):
            alike = [one for one in tested if (one.calculation.strain != "off") == softened]
            compounds = (compound for one in alike for compound in compounds_by_strand(one).values())
            TEST_FACTORS.solve(compounds, softened=softened)

    def prepare(self, asked: Mapping[int, tuple[Variant, CurveLoads]]) -> Iterator[tuple[int, PreparedLine | NoAnswer]]:
        """Prepare lines of variants under the loads on their curves, with their covers at small strain.

        An error where the belt lifts off on a concave curve or runs off its rolls on a horizontal one, a compound is
        unknown at the belt's temperature, or a law of roll drag is out of range at a load.
        """
        prepared: dict[int, PreparedLine | NoAnswer] = {}
        for i, (variant, on_curves) in asked.items():
            try:
                prepared[i] = self._line_without_drag(variant.conveyor, on_curves)
            except (NoSolutionError, RangeError, InputError) as error:
                prepared[i] = error
        self._calculate_drags(
            [(asked[i][0].conveyor, one) for i, one in prepared.items() if isinstance(one, PreparedLine)]
        )
        for i, one in prepared.items():
            try:
                yield i, self._with_drags_and_covers(asked[i][0], one) if isinstance(one, PreparedLine) else one
            except (NoSolutionError, RangeError, InputError) as error:
                yield i, error

    def _calculate_drags(self, lines: Iterable[tuple[Conveyor, PreparedLine]]) -> None:
        """Calculate the unknown drags of all rolls in one batch."""
        asked = {
            (one, _drag_air_temperature(given)): (given, one) for given, line in lines for one in line.line.strands.each
        }
        drags = self._kept.drags
        new = {key: pair for key, pair in asked.items() if key not in drags}
        drags.update(zip(new, roll_drags_many(list(new.values())), strict=True))

    def _with_drags_and_covers(self, variant: Variant, prepared: PreparedLine) -> PreparedLine:
        """Line with the drags of its rolls and its covers at small strain."""
        given, at = variant.conveyor, variant.covers_at
        compounds = compounds_by_strand(given)
        rubber = cover_series(given, lambda one: self._kept.once(partial(one.series, at), "series", (one,), (at,)))
        gives = given.calculation.support == "belt"
        acted = self._own if prepared.has_curve_loads else self._kept
        with_drags = acted.once(
            partial(self._with_roll_drags, prepared, _drag_air_temperature(given)),
            "in air",
            (prepared,),
            (_drag_air_temperature(given),),
        )
        rtol = with_drags.line.rtol if self._rtol is None else self._rtol
        cover_loadings = {
            strand: acted.once(
                partial(self._cover_loading, CoverLoading(with_drags.line, strand, cover, compounds[strand], at), rtol),
                "work",
                (with_drags.line, cover.series, compounds[strand], *((cover.opposite_cover[1],) if gives else ())),
                (strand, at, rtol),
            )
            for strand, cover in covers_by_strand(given, rubber).items()
        }
        return replace(
            with_drags, cover_loadings=cover_loadings, uses_rolling_tests=_uses_rolling_tests(given.calculation)
        )

    def _with_roll_drags(self, prepared: PreparedLine, air: float | None) -> PreparedLine:
        """Line with the drags of its rolls in air of a temperature [K]."""
        drags: list[tuple[float, ...]] = []
        for strand in prepared.line.strands.each:
            one = self._kept.drags[strand, air]
            if isinstance(one, InputError):
                raise one
            drags += one
        line = replace(prepared.line, roll_drags=tuple(drags))
        return replace(prepared, line=line, layout=prepared.layout.of(line))

    def _cover_loading(self, work: CoverLoading, rtol: float) -> CoverLoading:
        """First strand that loads its cover identically, with unresolved relaxation terms merged."""
        merged = self._merge_unresolved_terms(work, rtol)
        return self._kept.first(merged, "alike", (work.compound,), merged.key)

    def _merge_unresolved_terms(self, work: CoverLoading, rtol: float) -> CoverLoading:
        """Merge relaxation terms that the rolls of a strand cannot resolve."""
        times = resolved_time_range(work, rtol)
        if times is None:
            return work
        series, (fastest, slowest) = work.cover.series, times
        cut = tuple(series.times.searchsorted(times).tolist())
        less = self._kept.once(lambda: series.merged(fastest=fastest, slowest=slowest), "merged", (series,), cut)
        return replace(work, cover=replace(work.cover, series=less, merging_error=2.0 * TERM_MERGE_SHARE * rtol))

    def _line_without_drag(self, given: Conveyor, on_curves: CurveLoads) -> PreparedLine:
        """Line of a spec without roll drags."""
        acted = on_curves != CurveLoads()
        kept = self._own if acted else self._kept
        others = (given.material, given.route, given.drive, given.calculation, given.report)
        body, wind, curves = given.belt.body_fingerprint, given.ambient.wind_speed, vars(on_curves).values()
        key = (body, wind, part_key(given.site), *map(_item_tuple, curves))

        def made() -> PreparedLine:
            """Build the line; specs of equal belt, load and idlers share strands.

            `without_strands` has the strands of the first spec that it was made for: idlers do not matter to the rest.
            """
            sections = self._kept.once(lambda: route_sections(given), "sections", (given.route,))
            each = []
            for strand, own in zip(STRANDS, sets, strict=True):
                parts = (own, given.material, given.route, given.calculation)
                laid = partial(_strand_and_forces, given, sections, strand, on_curves)
                each.append(kept.once(laid, "strand", parts, (strand, *key)))
            (carry, up), (back, down) = each
            strands = Strands(sections, (carry, back))
            without_strands = self._kept.once(
                lambda: Line.of(given, strands, [(), ()]), "without strands", others, (body, wind)
            )
            return _prepare_line(replace(without_strands, strands=strands), (up, down), acted)

        sets = given.idlers.carry, given.idlers.return_
        return kept.once(made, "line", (*sets, *others), key)

    def soften(
        self, prepared: Mapping[int, PreparedLine], before: Mapping[int, Covers]
    ) -> dict[int, Covers | NoAnswer]:
        """Take covers of many lines to their working strain; identical ones are one object and share load curves.

        A cover of the step before is kept while its line load is unchanged.
        """
        for i, kept in before.items():
            for strand, cover in kept.items():
                if prepared[i].cover_loadings[strand].keeps_strain_of(cover):
                    self._softened.setdefault(prepared[i].cover_loadings[strand], cover)
        shared = {work for one in prepared.values() if not one.has_curve_loads for work in one.cover_loadings.values()}
        cover_loadings = dict.fromkeys(work for one in prepared.values() for work in one.cover_loadings.values())
        asked = [work for work in cover_loadings if work not in self._softened]
        known = self._kept.covers
        self._softened |= {work: one for work in asked if (one := known.pop(work, None)) is not None}
        new = [work for work in asked if work not in self._softened]
        runs = [
            [prepared[i].cover_loadings[strand] for i in run if i in prepared]
            for run in self._runs
            for strand in STRANDS
        ]
        unknown = set(new)
        covers = softened_covers(new, [run for run in runs if unknown.issuperset(run)])
        self._softened.update(zip(new, covers, strict=True))
        known |= {work: self._softened[work] for work in asked if work in shared}
        return {
            i: _all_or_error({strand: self._with_test_factor(one, strand) for strand in one.cover_loadings})
            for i, one in prepared.items()
        }

    def _with_test_factor(self, prepared: PreparedLine, strand: Strand) -> CoverState | NoAnswer:
        """Cover of a strand with the test factor of its compound, if any."""
        work = prepared.cover_loadings[strand]
        cover = self._softened[work]
        tested, softened = prepared.uses_rolling_tests, prepared.line.softened
        tests = TEST_FACTORS.of(work.compound, softened=softened) if tested else None
        if not isinstance(cover, CoverState) or isinstance(tests, NoAnswer):
            return tests if isinstance(tests, NoAnswer) else cover
        factor = None if tests is None else CoverTestFactor(tests, work.temperature, work.compound)
        if cover.test_factor == factor:
            return cover
        return self._kept.once(lambda: replace(cover, test_factor=factor), "test factor", (cover, tests))


def conveyor_test_factors(conveyor: Conveyor, compounds: Sequence[RubberCompound]) -> list[TestFactorAnswer]:
    """Test factors of compounds as a conveyor's calculation uses them; empty where it uses none."""
    if not _uses_rolling_tests(conveyor.calculation):
        return []
    softened = conveyor.calculation.strain != "off"
    TEST_FACTORS.solve(compounds, softened=softened)
    return [TEST_FACTORS.of(one, softened=softened) for one in compounds]


def _uses_rolling_tests(calculation: Calculation) -> bool:
    """True if rolling-resistance tests scale the indentation."""
    return calculation.anchor == "tests" and calculation.support in {"confined", "belt"}


def _strand_and_forces(
    conveyor: Conveyor, sections: tuple[RouteSection, ...], strand: Strand, on_curves: CurveLoads
) -> tuple[OneStrand, RubberFreeForces]:
    """A strand of a conveyor and its forces independent of rubber."""
    made = OneStrand.of(conveyor, sections, strand, on_curves)
    return made, strand_rubber_free_forces(made)


def _prepare_line(line: Line, rubber_free: Sequence[RubberFreeForces], acted: bool) -> PreparedLine:
    """Prepare a line without roll drags and loaded covers."""
    carry, back = rubber_free
    return PreparedLine(line, LoopLayout(line), carry.joined(back), acted)


def _drag_air_temperature(conveyor: Conveyor) -> float | None:
    """Air temperature at the rolls [K], where their drag depends on it."""
    return conveyor.air_temperature if conveyor.idlers.drag_follows_air else None


def _item_tuple(figures: Mapping[tuple[str, Strand], float]) -> tuple[object, ...]:
    return tuple(figures.items())


def _all_or_error(covers: Mapping[Strand, CoverState | NoAnswer]) -> Covers | NoAnswer:
    """Covers of all strands, or the first error."""
    for cover in covers.values():
        if not isinstance(cover, CoverState):
            return cover
    return {strand: cover for strand, cover in covers.items() if isinstance(cover, CoverState)}
