"""Worst loading of each criterion, the take-up at its setting.

On a short route every loading is tried. On a longer one those by signs: a tension at constant speed and the holding
force are sums over the sections, quantities of resistance and mass are worst at a corner of all their sums; then
sections are changed one by one until no change makes a figure worse. Figures here equal those of the criteria or rise
with them.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import replace
from functools import cache, cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from conveyor.classical_forces import initial_pull
from conveyor.errors import NoSolutionError
from conveyor.laws.motion import bulk_slip_limits
from conveyor.laws.resistance.resistance_defaults import ROLL_DRAG_STANDSTILL_FACTOR
from conveyor.laws.tension import grip_tension
from conveyor.line.set_limits import raised_height
from conveyor.line.stretches import STRANDS
from conveyor.loop.equilibrium import (
    BRAKES,
    BRAKING,
    COASTING,
    DESIGN_START,
    FILLED,
    LEAST,
    LEAST_BRAKING,
    RUN_OUT,
    START,
)
from conveyor.loop.load_superposition import Array, Loading, MotionCase, SectionLoadings, limits_sag
from conveyor.loop.run_up import is_start_uncontrolled, rated_force, start_force_ratio
from conveyor.loop.tensions import STEADY

EXHAUSTIVE_SECTIONS: Final = 10
"""Number of sections up to which every loading is tried."""
SINGLE_CHANGE_SECTIONS: Final = 40
"""Number of sections up to which they are changed one by one and every curve and raised set is evaluated."""
_SLIP_CANDIDATES: Final = 3  # sections whose bulk slips first
_MAX_ROUNDS: Final = 20  # of changes; every one makes a figure worse, and few take more than five
_MAX_CORNERS: Final = 64  # of each pair of sums on a long route; a sixty-fourth of a turn costs 1e-3 of their range
_ROUNDING: Final = 1e-9  # of a figure: rounding

LoadingRows = NDArray[np.bool_]
"""Loadings, one in a row, shape (m, n)."""
CriterionFigures = dict[str, Array]
"""Values of each figure under loadings, shape (m,): the higher the worse, -inf for none."""


class CriterionLoadings(SectionLoadings):
    """Loadings of one conveyor between empty and full, and the worst of each criterion."""

    def worst_of_each(self) -> dict[str, tuple[float, Loading]]:
        """Highest value of every figure and the first loading with it, by the figure's name; SI."""
        best: dict[str, tuple[float, Loading]] = {}
        known: set[bytes] = set()
        flags = self._first_tried()
        for _ in range(_MAX_ROUNDS):
            known |= {row.tobytes() for row in flags}
            before = dict(best)
            for name, values in self.criterion_figures(flags).items():
                most = float(values.max())
                slack = _ROUNDING * abs(most)
                if most > -np.inf and (name not in best or most > best[name][0] + slack):
                    best[name] = (most, flags[int(np.argmax(values >= most - slack))])
            if best == before or not EXHAUSTIVE_SECTIONS < self.count <= SINGLE_CHANGE_SECTIONS:
                break
            single = np.eye(self.count, dtype=bool)
            near = np.concatenate([loading ^ single for _, loading in best.values()])
            flags = np.array([row for row in _distinct_rows(near) if row.tobytes() not in known])
            if not flags.size:
                break
        return best

    def _first_tried(self) -> LoadingRows:
        """All loadings of a short route, the standard ones first; on a long one those by signs."""
        standard = np.array(self.standard)
        if self.count <= EXHAUSTIVE_SECTIONS:
            first, every = _distinct_rows(standard), _all_loadings(self.count)
            return np.concatenate([first, every[~(every[:, None] == first).all(axis=-1).any(axis=-1)]])
        of_drives = np.array(list(self.worst().values()))
        return _distinct_rows(np.concatenate([standard, of_drives, self._corners(), np.array(list(self._by_signs()))]))

    def _corners(self) -> LoadingRows:
        """Loadings at corners of the sums of resistance and mass, with sections that slip first."""
        mass, rows = self._masses[1], list[LoadingRows]()
        every = [self.resistance(friction)[1] for friction in self._frictions]
        for more in (*every, self.resistance(self.line.design_friction)[1] + self._sticking[1]):
            square = 0.5 * np.pi
            turns = np.sort(np.concatenate([np.arctan2(mass, more) + s * square for s in (-1.0, 1.0)]))
            between = 0.5 * (turns + np.append(turns[1:], turns[0] + 4.0 * square))
            if self.count > SINGLE_CHANGE_SECTIONS:  # neighbouring corners differ by a section or two
                between = between[:: math.ceil(between.size / _MAX_CORNERS)]
            rows.append(np.outer(np.cos(between), more) + np.outer(np.sin(between), mass) > 0.0)
        corners = np.concatenate(rows)
        *limits, slides = self._slip_limits
        first = [np.arange(self.count) == k for limit in limits for k in np.argsort(limit)[:_SLIP_CANDIDATES]]
        return np.concatenate([corners, *((corners | one) & ~slides for one in first)])

    def _by_signs(self) -> Iterator[Loading]:
        """Loadings with the highest and the lowest tension at constant speed, at every place evaluated."""
        events = self.events
        everywhere = range(events.force.size + 1)
        places = everywhere if self.count <= SINGLE_CHANGE_SECTIONS else sorted(self._places)
        for friction in self._frictions:
            step = events.more_certain + friction * (events.more_force - events.more_certain)
            whole = self.resistance(friction)[1]
            for at in places:
                weights = self._weights(at)
                rise = events.by_section(weights * step, self.count)
                rise -= float(weights[self.drive_at] @ self.shares) * whole
                yield rise > 0.0
                yield rise < 0.0

    @cached_property
    def _frictions(self) -> tuple[float, ...]:
        """Frictions of the states of motion over the computed one [-]: expected, to design for, least."""
        return tuple(dict.fromkeys((1.0, self.line.design_friction, self.line.least_friction)))

    @cached_property
    def _places(self) -> set[int]:
        """Places whose tension a criterion uses."""
        places = {at for d in self.drive_at.tolist() for at in (d, d + 1)}
        places |= {at for several in self._pulleys.values() for at in several}
        for k in (*self._stretches, self.count, 2 * self.count - 1):
            places |= {int(self.stretch_at[k]), int(self.stretch_end[k])}
        return places

    @cached_property
    def _pulleys(self) -> dict[int, list[int]]:
        """Places on both sides of every pulley without the take-up's tension, by the pulley's number."""
        line, places = self.line, {}
        for i, pulley in enumerate(line.pulleys):
            if line.take_up.pulls(pulley) or pulley.assumed:
                continue
            pairs = zip(line.drives, self.drive_at.tolist(), strict=True)
            beside = [d for drive, d in pairs if pulley.driven and drive.spot == pulley.spot]
            before = self.events.spots[self.full.layout.at[pulley.spot]]
            places[i] = [at for d in beside for at in (d, d + 1)] or [before]
        return places

    @cached_property
    def _stretches(self) -> tuple[int, ...]:
        """Stretches with curves or raised sets, in loop order."""
        line = self.line
        if self.count > SINGLE_CHANGE_SECTIONS:
            return ()
        curved = {section.name for section in line.sections if section.curved}
        return tuple(
            k for k, one in enumerate(line.loop.stretches) if one.section in curved or raised_height(one) > 0.0
        )

    @cached_property
    def _sticking(self) -> tuple[float, Array]:
        """Addition to rolls and hoppers after standstill [N], at the friction to design for; as in `at_rest`."""
        drags = []
        for one in (self.empty, self.full):
            drag = next(
                (force.newtons for force in one.along if force.key == "idler_rotation"), one.line.roll_drag_forces
            )
            drags.append(np.broadcast_to(drag, 2 * self.count))
        bare, laden = drags
        share = self.line.design_friction * (ROLL_DRAG_STANDSTILL_FACTOR - 1.0)
        more = share * (laden - bare)[: self.count]
        for point in self.full.line.loading:
            more[point.comes_with] += self.line.design_friction * initial_pull(self.full.line, point)
        return share * float(bare.sum()), more

    @cached_property
    def _slip_limits(self) -> tuple[Array, Array, Loading]:
        """Deceleration and acceleration at which each section's bulk slips [m/s²]; mask of those that always slip."""
        slowing, starting = np.full((2, self.count), np.inf)
        slides = np.zeros(self.count, dtype=bool)
        for i, stretch in enumerate(self.full.line.stretches[: self.count]):
            if stretch.bulk_mass == 0.0:
                continue
            try:
                low, high = bulk_slip_limits(
                    self.line.bulk_belt_friction, inclination=stretch.inclination, gravity=self.line.gravity
                )
            except NoSolutionError:
                slides[i] = True
                continue
            slowing[i], starting[i] = -low, high
        return slowing, starting, slides

    def criterion_figures(self, flags: LoadingRows) -> CriterionFigures:
        """Figures of the criteria under loadings.

        Parameters
        ----------
        flags : ndarray of bool, shape (m, n)
            Masks of loaded sections.

        Returns
        -------
        dict of str to ndarray, shape (m,)
            Values by figure name; SI, the higher the worse, -inf for none.
        """
        return self._of_motion(flags) | self._of_tension(flags)

    def _sums(self, linear: tuple[float, Array], flags: LoadingRows) -> Array:
        """A sum over the sections under loadings, shape (m,)."""
        return np.asarray(linear[0] + flags @ linear[1])

    def _of_motion(self, flags: LoadingRows) -> CriterionFigures:
        """Figures that depend on resistance and mass alone."""
        line, figures = self.line, CriterionFigures()
        steady, most, least = (
            self._sums(self.resistance(f), flags) for f in (1.0, line.design_friction, line.least_friction)
        )
        mass = self._sums(self._masses, flags)
        whole, brakes = mass + self.rotating.sum(), float(self.brakes.sum())
        if line.stop_deceleration is not None:
            figures["stopping brake"] = line.stop_deceleration * whole - least
        figures["coast-down stop"] = _where_present(least > 0.0, whole / np.where(least > 0.0, least, 1.0))
        slowing = figures["coasting"] = np.maximum(most, 0.0) / whole
        if brakes > 0.0:
            gripping = np.maximum(0.0, line.speed - least / whole * line.brake_delay)
            braked = np.where(gripping > 0.0, least + brakes, least) / whole
            stops = (braked > 0.0) & (gripping > 0.0)
            after = gripping / np.where(stops, braked, 1.0)
            figures["brake heat"] = _where_present(stops, 0.5 * brakes * gripping * after)
            unbraked = line.speed * whole / np.where(least > 0.0, least, 1.0)
            figures["stop with brakes"] = np.where(
                stops, line.brake_delay + after, _where_present((gripping == 0.0) & (least > 0.0), unbraked)
            )
            grips = line.speed > most / whole * line.brake_delay
            slowing = np.maximum(slowing, np.where(grips, most + brakes, most) / whole)
        starts = np.array([self._motion(self._states[1], force, mass)[0] for force in (steady, most, least)])
        *limits, slides = self._slip_limits
        hard, fast = (np.where(flags, limit, np.inf).min(axis=-1) for limit in limits)
        rests = np.asarray(~(flags & slides).any(axis=-1))
        figures["slip on stopping"] = _where_present(rests, np.maximum(slowing, -starts.min(axis=0)) / hard)
        figures["slip on starting"] = _where_present(rests, np.maximum(starts.max(axis=0), 0.0) / fast)
        pulls, pull = most > 0.0, self.full.layout.standing.pull
        if pull.kind == "limited":
            asked = start_force_ratio(pull, np.where(pulls, most, 1.0), mass)
            figures["start of the motors"] = _where_present(pulls, asked)
        at_rest, rated = np.ones_like(most), rated_force(line)  # motors not given are one for every load
        if is_start_uncontrolled(line):
            at_rest = most + (line.torque_curve[0][1] * (rated or 0.0) - most) * mass / whole
        elif rated is not None:
            pushing = self._motion(self._states[1], most, mass)[1]
            at_rest = np.maximum(pushing.sum(axis=0), rated)
        figures["breakaway"] = _where_present(pulls, -at_rest / (most + self._sums(self._sticking, flags)))
        return figures

    def _of_tension(self, flags: LoadingRows) -> CriterionFigures:
        """Figures that depend on tensions, in every state of motion that occurs under each loading."""
        line, figures = self.line, CriterionFigures()
        resistances = {friction: self._sums(self.resistance(friction), flags) for friction in self._frictions}
        fed = self._has_hoppers(flags)
        steady, least = resistances[1.0], resistances[line.least_friction]
        mass, brakes = self._sums(self._masses, flags), float(self.brakes.sum())
        occurs = {
            DESIGN_START: resistances[line.design_friction] > 0.0,
            LEAST: least < 0.0,
            LEAST_BRAKING: least < 0.0,
            BRAKES: least + brakes > 0.0,
            COASTING: steady > 0.0,
            FILLED: fed,
            RUN_OUT: fed,
        }
        means = dict[str, Array]()
        for state in (*self._states, replace(self._states[0], name=COASTING, over=None)):
            here = occurs.get(state.name, np.ones(len(flags), dtype=bool))
            if not here.any():
                continue
            resistance = self._sums(self.resistance(state.friction, state.hoppers), flags)
            acceleration, forces = self._motion(state, resistance, mass)
            tensions = self.setting + self._over_the_take_up(state, flags, acceleration, forces)
            ends = np.stack([tensions[:, self.stretch_at], tensions[:, self.stretch_end]])
            means[state.name] = tensions @ self._mean_weights
            found = dict(self._of_places(tensions, flags))
            found |= {"mean": means[state.name], "least mean": -means[state.name]}
            for drive, force in zip(line.drives, forces, strict=True):
                found[f"force of {drive.name}"] = np.abs(force)
            if limits_sag(state):
                found |= self._of_sag(ends.min(axis=0), flags)
            for name, everywhere in found.items():
                values = _where_present(here, everywhere)
                figures[name] = np.maximum(figures.get(name, values), values)
                if state.name == STEADY:
                    figures[f"{name}, steady"] = values
            for drive, d, force in zip(line.drives, self.drive_at.tolist(), forces, strict=True):
                asked = grip_tension(1.0, friction=drive.friction, wrap_angle=drive.wrap_angle) * np.abs(force)
                slack = np.minimum(tensions[:, d], tensions[:, d + 1])
                pulls = asked > 0.0
                over = -slack / np.where(pulls, asked, 1.0)
                for name, there in _state_names(state.name, here, steady):
                    figures[f"grip of {drive.name}, {name}"] = _where_present(there & pulls, over)
                    figures[f"slack at {drive.name}, {name}"] = _where_present(there & ~pulls, -slack)
            if state.name == START:
                figures["speed of the carriage"] = np.abs((means[START] - means[STEADY]) * acceleration)
        return figures

    def _over_the_take_up(self, state: MotionCase, flags: LoadingRows, acceleration: Array, forces: Array) -> Array:
        """Tension before and behind every event over the take-up's [N], shape (m, e + 1)."""
        events = self.events
        step, more = self._steps(state.friction, state.hoppers)
        on = np.column_stack([flags, np.zeros(len(flags), dtype=bool)])[:, events.section]
        steps = step + on * more + acceleration[:, None] * (events.mass + on * events.more_mass)
        steps[:, self.drive_at] -= forces.T
        offsets = np.concatenate([np.zeros((len(flags), 1)), np.cumsum(steps, axis=-1)], axis=-1)
        return np.asarray(offsets - (offsets @ self._anchor)[:, None])

    def _of_places(self, tensions: Array, flags: LoadingRows) -> Iterator[tuple[str, Array]]:
        """Tensions of one state that criteria use; the lowest with reversed sign."""
        yield "tension", tensions.max(axis=-1)
        yield "slack", -tensions.min(axis=-1)
        for i, places in self._pulleys.items():
            sides = tensions[:, places]
            yield f"pulley {i}", sides.sum(axis=-1)
            yield f"tight side of pulley {i}", sides.max(axis=-1)
        for k in self._stretches:
            ends = tensions[:, [self.stretch_at[k], self.stretch_end[k]]]
            high, low = ends.max(axis=-1), ends.min(axis=-1)
            yield f"stretch {k}", high
            yield f"least of stretch {k}", -low
            if k >= self.count:  # its bulk holds a curve and bears on its sets
                for words, on in (("loaded", flags[:, k - self.count]), ("empty", ~flags[:, k - self.count])):
                    yield f"stretch {k}, {words}", _where_present(on, high)
                    yield f"least of stretch {k}, {words}", _where_present(on, -low)
        if self.line.transitions:
            transition_at = {
                "tail": self.stretch_at[self.count], "head": self.stretch_end[-1],
                "tail, return": self.stretch_end[self.count - 1], "head, return": self.stretch_at[0],
            }  # fmt: skip
            for end in (zone.name for zone in self.line.transitions):
                there = tensions[:, transition_at[end]]
                yield f"transition, {end}", there
                yield f"least of transition, {end}", -there

    def _of_sag(self, low: Array, flags: LoadingRows) -> Iterator[tuple[str, Array]]:
        """Lowest tension of each strand over that needed for the sag, with reversed sign."""
        on = np.column_stack([np.ones_like(flags), flags])
        needed = self.least + on * self.more_least
        for strand in STRANDS:
            on_sets = [k for k, one in enumerate(self.line.loop.stretches) if one.strand == strand and one.bed is None]
            if on_sets:
                yield f"sag, {strand}", -(low[:, on_sets] / needed[:, on_sets]).min(axis=-1)


def _state_names(state: str, here: NDArray[np.bool_], steady: Array) -> Iterator[tuple[str, NDArray[np.bool_]]]:
    """Names of a state and masks of the loadings that have them: a belt that drives brakes instead of starting."""
    if state != START:
        yield state, here
    else:
        yield START, here & (steady >= 0.0)
        yield BRAKING, here & (steady < 0.0)


def _where_present(there: NDArray[np.bool_], values: Array) -> Array:
    """Values where the mask is true, else -inf."""
    return np.where(there, values, -np.inf)


@cache
def _all_loadings(count: int) -> LoadingRows:
    """All loadings of a number of sections, from full to empty."""
    return np.array(list(itertools.product([True, False], repeat=count)))


def _distinct_rows(flags: LoadingRows) -> LoadingRows:
    """Distinct loadings in their order."""
    return np.array(list({row.tobytes(): row for row in flags}.values()))
