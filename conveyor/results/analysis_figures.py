"""Figures of results: `analysis.plots.tensions()`, `comparison.plots.loss_tangents()`.

Matplotlib figures are returned, never shown or saved; `conveyor.report.plots.save_figure` writes one.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from conveyor.errors import InputError
from conveyor.line.stretches import Strand
from conveyor.models import Conveyor
from conveyor.models.variants import scale_quantity
from conveyor.report import analysis_plots, plots
from conveyor.report.tables import transfer_tables
from conveyor.report.tables.curve_tables import drifts_by_case
from conveyor.report.tables.loop_tables import section_boundaries
from conveyor.studies import CalculatedStudies
from conveyor.studies.comparison_scenes import calculate_compound
from conveyor.studies.loads import design_loads
from conveyor.units import Quantity, System, quantity
from conveyor.units.sentences import to_celsius
from conveyor.units.unit_systems import report_system

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from conveyor.calculated_conveyor import CalculatedConveyor
    from conveyor.studies.comparison import CalculatedComparison

_TEMPERATURE_STEPS: Final = tuple(range(-40, 41, 5))  # from the spec's belt temperature [K]
_SPEED_FACTORS: Final = tuple(round(0.6 + 0.1 * k, 1) for k in range(9))  # on the spec's belt speed
_RTOL: Final = 1e-4  # of the contacts: less than a line's width
_STRANDS: Final[tuple[Strand, ...]] = ("carry", "return")


@dataclass(frozen=True, eq=False)
class AnalysisPlots:
    """Figures of one analysis; `system` is SI or US, by default that of the spec's report.

    Examples
    --------
    >>> import conveyor
    >>> result = conveyor.analyse(conveyor.load("examples/specs/overland.yaml"))  # doctest: +SKIP
    >>> result.plots.tensions(system="US").savefig("tensions.png")  # doctest: +SKIP
    """

    analysis: CalculatedConveyor

    def resistances(self, *, system: System | None = None) -> Figure:
        """Every kind of resistance, with the classical estimates."""
        return analysis_plots.resistance_breakdown(self.analysis.balance, system=self._in(system))

    def tensions(self, *, system: System | None = None) -> Figure:
        """Tension round the loop in every state, and the least allowed by sag."""
        result = self.analysis
        return analysis_plots.tension_diagram(result.balance, result.motions, system=self._in(system))

    def flap(self, *, system: System | None = None) -> Figure:
        """Natural frequencies of the belt between idler sets, and rotation frequencies of their rolls."""
        return analysis_plots.flap_diagram(self.analysis, system=self._in(system))

    def profile(self, *, system: System | None = None) -> Figure:
        """Height of the route over its length, with feeding points, drives and vertical curves."""
        conveyor = self.analysis.conveyor
        return analysis_plots.route_profile(
            conveyor, self.analysis.line, section_boundaries(self.analysis.line), system=self._in(system)
        )

    def trajectory(self, *, system: System | None = None) -> Figure:
        """The stream over the head pulley, to scale.

        Raises
        ------
        InputError
            The spec does not request it, or no bulk arrives at the head.
        """
        if self.analysis.trajectory is None:
            raise InputError("no trajectory: give route.discharge, and bulk that reaches the head")
        return transfer_tables.discharge_figure(self.analysis, system=self._in(system))

    def cross_section(self, *, system: System | None = None) -> Figure:
        """Idler set of each strand with belt and bulk, to scale."""
        result = self.analysis
        return analysis_plots.cross_section(result.conveyor, result.line, system=self._in(system))

    def plan(self, *, system: System | None = None) -> Figure:
        """Plan view of the route with its horizontal curves."""
        return analysis_plots.plan_view(self.analysis.line, system=self._in(system))

    def drift(self, studies: CalculatedStudies | None = None, *, system: System | None = None) -> Figure:
        """Drift of the belt in every horizontal curve over all states of motion, and all cases of the studies if given.

        Raises
        ------
        InputError
            The route has no horizontal curve.
        """
        if not self.analysis.horizontal:
            raise InputError("drift: the route has no horizontal curve (route.sections[].horizontal_curve)")
        shown, held = self._in(system), CalculatedStudies() if studies is None else studies
        loads = design_loads(self.analysis, held.states, held.cases)
        return analysis_plots.drift_diagram(drifts_by_case(loads, shown), system=shown)

    def pressure(self, *, system: System | None = None) -> Figure:
        """Contact pressure under the highest line load of each strand."""
        return analysis_plots.pressure_under_rolls(self.analysis.contacts, system=self._in(system))

    def rubber(self, strand: Strand = "carry", *, system: System | None = None) -> Figure:
        """Master curve of the rubber under a strand's rolls, with the bands excited by all rolls on it."""
        conveyor = self.analysis.conveyor
        compounds = {"carry": conveyor.carry_compound, "return": conveyor.return_compound}
        chosen_one = compounds[strand]
        on_it = tuple(each for each in _STRANDS if compounds[each].name == chosen_one.name)
        contacts = self.analysis.contacts
        return analysis_plots.excited_master_curve(
            chosen_one, conveyor.temperature, contacts, on_it, system=self._in(system)
        )

    def power_against_temperature(
        self, temperatures: Iterable[str | Quantity] | None = None, *, system: System | None = None
    ) -> Figure:
        """Motor power over the belt's temperature, everything else as in the spec.

        Parameters
        ----------
        temperatures : iterable of str or Quantity, optional
            Of the belt ("-20 degC"); by default every 5 K up to 40 K about the spec's, as far as there is an answer.
        system : {"SI", "US"}, optional
            Units of the axes.

        Raises
        ------
        InputError
            A temperature is refused, or none has an answer.
        """
        conveyor = self.analysis.conveyor
        at = to_celsius(conveyor.temperature)
        around = [quantity(f"{at + step:.9g} degC", "temperature") for step in _TEMPERATURE_STEPS]
        given = around if temperatures is None else [quantity(t, "temperature") for t in temperatures]
        varied = _sweep_conveyor(conveyor, given, [conveyor.belt.speed])
        return plots.power_over(varied, "temperature", system=self._in(system))

    def power_against_speed(
        self, speeds: Iterable[str | Quantity] | None = None, *, system: System | None = None
    ) -> Figure:
        """Motor power over belt speed at the spec's mass flow, everything else as in the spec.

        Parameters
        ----------
        speeds : iterable of str or Quantity, optional
            Of the belt ("5 m/s"); by default 0.6 to 1.4 of the spec's, as far as the bulk fits the belt.
        system : {"SI", "US"}, optional
            Units of the axes.

        Raises
        ------
        InputError
            A speed is refused, or none has an answer.
        """
        conveyor = self.analysis.conveyor
        around = [scale_quantity(conveyor.belt.speed, times) for times in _SPEED_FACTORS]
        given = around if speeds is None else [quantity(v, "speed") for v in speeds]
        varied = _sweep_conveyor(conveyor, [conveyor.ambient.belt], given)
        return plots.power_over(varied, "speed", system=self._in(system))

    def every(self, studies: CalculatedStudies | None = None, *, system: System | None = None) -> dict[str, Figure]:
        """All figures by name, and those of the studies if given."""
        result, conveyor = self.analysis, self.analysis.conveyor
        rubbers = _STRANDS[: 1 if conveyor.carry_compound.name == conveyor.return_compound.name else 2]
        drawn = [self.resistances, self.tensions, self.profile, self.cross_section]
        drawn += [self.plan] if result.horizontal else []
        drawn += [] if result.trajectory is None else [self.trajectory]
        drawn += [self.pressure, *([self.flap] if result.set_duty else [])]
        made = {
            **{draw.__name__.replace("_", "-"): draw(system=system) for draw in drawn},
            **({"drift": self.drift(studies, system=system)} if result.horizontal else {}),
            **{f"rubber-{strand}": self.rubber(strand, system=system) for strand in rubbers},
            "power-temperature": self.power_against_temperature(system=system),
            "power-speed": self.power_against_speed(system=system),
        }
        return made if studies is None else made | dict(_study_figures(studies, self._in(system)))

    def _in(self, system: System | None) -> System:
        return report_system(self.analysis.conveyor.report.units, system)


def _sweep_conveyor(conveyor: Conveyor, temperatures: list[Quantity], speeds: list[Quantity]) -> plots.ConveyorSweep:
    compound = conveyor.carry_compound
    varied = calculate_compound(conveyor, compound, temperatures, speeds, cover="bottom", rtol=_RTOL, lot_scatter=0.0)
    if not varied.scenes:
        why = "; ".join(dict.fromkeys(refusal.reason for refusal in varied.refused))
        raise InputError(f"nothing to draw: {why}")
    return plots.ConveyorSweep(conveyor, (compound,), varied.scenes, varied.coverage)


def _study_figures(studies: CalculatedStudies, system: System) -> Iterator[tuple[str, Figure]]:
    cases = studies.cases
    if cases is not None and len({result.temperature for result in cases.results}) > 1:
        yield "cases-temperature", analysis_plots.case_power(cases, "temperature", system=system)
    if cases is not None and len({result.speed for result in cases.results}) > 1:
        yield "cases-speed", analysis_plots.case_power(cases, "speed", system=system)
    if studies.uncertainty is not None:
        yield "ranges", analysis_plots.tornado_chart(studies.uncertainty, system=system)
        exact = studies.uncertainty.monte_carlo
        if exact is not None:
            yield "draws", analysis_plots.interval_convergence(exact, studies.uncertainty.sampled, system=system)


@dataclass(frozen=True, eq=False)
class ComparisonPlots:
    """Figures of a comparison; `system` is SI or US, by default that of the spec's report."""

    comparison: CalculatedComparison

    def power_against_temperature(self, speed: float | None = None, *, system: System | None = None) -> Figure:
        """Motor power of every compound over temperature at one speed [m/s], by default that next to the spec's."""
        return plots.power_over(self.comparison, "temperature", speed, system=self._in(system))

    def power_against_speed(self, temperature: float | None = None, *, system: System | None = None) -> Figure:
        """Motor power of every compound over speed at one temperature [K], by default that next to the spec's."""
        return plots.power_over(self.comparison, "speed", temperature, system=self._in(system))

    def loss_tangents(self, temperature: float | None = None, *, system: System | None = None) -> Figure:
        """Loss tangents at one temperature [K], by default the spec's, and the band excited by the rolls."""
        return plots.compared_loss_tangents(self.comparison, temperature, system=self._in(system))

    def _in(self, system: System | None) -> System:
        return report_system(self.comparison.conveyor.report.units, system)
