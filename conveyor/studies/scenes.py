"""Many variants of a conveyor calculated side by side: load cases, bars of a duty, ranges of inputs.

All contacts of all variants are solved in one batch; variants of one rubber and temperature share its series, rolls
that share a contact its load curve. On vertical curves tensions and roll loads are iterated in step.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from typing import TypeAlias

from conveyor.errors import InputError, NoSolutionError, RangeError
from conveyor.line.stretches import Strand
from conveyor.line.walk import Surface, Surfaces, Track, indented, surfaces, worked_surfaces
from conveyor.loop.curved import Masses, Run, Settling, settling
from conveyor.models import Conveyor, Idlers, RubberCompound
from conveyor.rubber import PronySeries
from conveyor.units import Quantity, si

NoAnswer: TypeAlias = NoSolutionError | RangeError | InputError
Progress: TypeAlias = Callable[[int, int], None]
"""Called with what is done and the whole; what is done never falls."""


@dataclass(frozen=True, eq=False)
class Scene:
    """A conveyor, and what of it is not as its spec says.

    Attributes
    ----------
    conveyor : Conveyor
        Its ambient gives the temperature.
    rubber : mapping of strand to PronySeries
        Covers' rubber at the belt's temperature instead of the compounds' [Pa, s].
    drag : float
        Drag of all rolls over the computed one [-].
    """

    conveyor: Conveyor
    rubber: Mapping[Strand, PronySeries] = field(default_factory=dict)
    drag: float = 1.0


def runs(
    scenes: Sequence[Scene], rtol: float | None = None, progress: Progress | None = None
) -> list[Run | NoAnswer]:
    """Calculate every scene as `curved.run` would; all contacts of all scenes side by side.

    Parameters
    ----------
    scenes : sequence of Scene
        The variants.
    rtol : float, optional
        Relative tolerance of the contacts; that of each spec without it [-].
    progress : callable, optional
        Called as scenes are loaded, and when they are solved; a scene counts half for each.

    Returns
    -------
    list
        In their order the runs, or why a scene has none.
    """
    found: dict[int, Run | NoAnswer] = {}
    advanced = _Advance(len(scenes), progress)
    covers = _covers(scenes, found)
    shared = _Tracks(rtol), _Worked()
    going: dict[int, tuple[Settling, Masses]] = {}
    for i in covers:
        steps = settling(scenes[i].conveyor)
        going[i] = steps, next(steps)
    while going:
        going = _step(scenes, covers, shared, going, found, advanced=advanced)
    return [found[i] for i in range(len(scenes))]


def _step(
    scenes: Sequence[Scene],
    covers: Mapping[int, Surfaces],
    shared: tuple[_Tracks, _Worked],
    going: Mapping[int, tuple[Settling, Masses]],
    found: dict[int, Run | NoAnswer],
    *,
    advanced: _Advance,
) -> dict[int, tuple[Settling, Masses]]:
    """Load the rolls of every scene anew, solve them together; those that are settled go into `found`."""
    tracks, worked = shared
    jobs: dict[int, tuple[Track, Surfaces]] = {}
    for i, (_, pressing) in going.items():
        try:
            track = tracks.of(scenes[i], pressing)
            jobs[i] = track, worked.of(track, covers[i])
        except (NoSolutionError, RangeError, InputError) as error:
            found[i] = error
        advanced(len(found), len(jobs))
    walked = indented([track for track, _ in jobs.values()], [cover for _, cover in jobs.values()])
    left = {}
    for i, results in zip(jobs, walked, strict=True):
        if isinstance(results, NoSolutionError):
            found[i] = results
            continue
        steps = going[i][0]
        try:
            left[i] = steps, steps.send(results)
        except StopIteration as end:
            found[i] = end.value
        except NoSolutionError as error:
            found[i] = error
    advanced(len(found), 0)
    return left


class _Advance:
    """Tells how far a batch is; a scene that must be loaded once more takes nothing back."""

    def __init__(self, scenes: int, progress: Progress | None) -> None:
        self._whole, self._most, self._progress = 2 * scenes, 0, progress

    def __call__(self, solved: int, loaded: int) -> None:
        self._most = max(self._most, 2 * solved + loaded)
        if self._progress is not None:
            self._progress(self._most, self._whole)


class _Worked:
    """Covers at the strain of their rolls; of tracks that bear alike on one cover, formed once."""

    def __init__(self) -> None:
        self._known: dict[tuple[Hashable, ...], tuple[Surfaces, Surfaces]] = {}

    def of(self, track: Track, covers: Surfaces) -> Surfaces:
        """As `line.worked_surfaces`; the very surfaces of an alike track, so that load curves are shared."""
        conveyor = track.conveyor
        at = si(conveyor.ambient.belt)
        key = (
            (at, track.speed, conveyor.calculation.strain, conveyor.calculation.support),
            (id(conveyor.carry_compound), id(conveyor.return_compound)),
            *((strand, id(cover.rubber), cover.thickness) for strand, cover in covers.items()),
            *(
                (
                    kind.strand,
                    kind.radius,
                    kind.spacing,
                    kind.line_loads.tobytes(),
                    (kind.weights * kind.sets).tobytes(),
                )
                for kind in track.kinds
            ),
        )
        if key not in self._known:
            # the given covers are kept with them: an id is its object's only while it lives
            self._known[key] = covers, worked_surfaces(track, covers, at)
        return self._known[key][1]


class _Tracks:
    """Loads of the rolls and forces without rubber; scenes that differ in rubber and temperature share them."""

    def __init__(self, rtol: float | None) -> None:
        self._rtol = rtol
        self._known: dict[tuple[Hashable, ...], tuple[Conveyor, Track]] = {}

    def of(self, scene: Scene, pressing: Masses) -> Track:
        """The track of a scene.

        Raises
        ------
        NoSolutionError
            The belt lifts off on a concave curve.
        InputError
            A law of roll drag does not hold at a load.
        """
        conveyor = scene.conveyor
        parts = (conveyor.belt, conveyor.idlers, conveyor.material, conveyor.route, conveyor.calculation)
        air = si(conveyor.ambient.temperature) if _drag_follows_the_air(conveyor.idlers) else None
        key = (*map(id, parts), air, frozenset(pressing.items()))
        if key not in self._known:
            # the conveyor is kept with its track: an id is its object's only while it lives
            self._known[key] = conveyor, Track(conveyor, self._rtol, pressing)
        track = copy(self._known[key][1])
        track.conveyor = conveyor
        if scene.drag != 1.0:
            track.fixed = tuple(
                replace(forces, rotation=scene.drag * forces.rotation) for forces in track.fixed
            )
        return track


def _drag_follows_the_air(idlers: Idlers) -> bool:
    rolls = [roll for each in (idlers.carry, idlers.return_) for roll in (each.roll, each.middle)]
    return any(roll.drag_law is not None for roll in rolls)


def _covers(scenes: Sequence[Scene], found: dict[int, Run | NoAnswer]) -> dict[int, Surfaces]:
    """The covers of every scene; a compound's series at a temperature is formed once."""
    known: list[tuple[RubberCompound, RubberCompound, float, dict[Strand, Surface]]] = []
    covers: dict[int, Surfaces] = {}
    for i, scene in enumerate(scenes):
        conveyor, at = scene.conveyor, si(scene.conveyor.ambient.belt)
        carry, back = conveyor.carry_compound, conveyor.return_compound
        same = next((c for a, b, t, c in known if a is carry and b is back and t == at), None)
        try:
            formed = surfaces(conveyor, at) if same is None else same
        except RangeError as error:
            found[i] = error
            continue
        if same is None:
            known.append((carry, back, at, formed))
        thick: dict[Strand, Quantity] = {
            "carry": conveyor.belt.bottom_cover.thickness,
            "return": conveyor.return_cover_thickness,
        }
        covers[i] = {
            strand: replace(
                surface, thickness=si(thick[strand]), rubber=scene.rubber.get(strand, surface.rubber)
            )
            for strand, surface in formed.items()
        }
    return covers
