"""Contacts of the rolls on a belt whose carcass deflects, the more the lower its tension.

Each contact is solved at Chebyshev-Lobatto points of ln tension, as many as the tolerance needs, and interpolated
between.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from conveyor.contact import solve
from conveyor.contact.galerkin.sampling import interpolation_errors, interpolation_weights, lobatto_points
from conveyor.errors import MessageQuantity, NoSolutionError
from conveyor.indentation import Indentation, IndentationCurve, RollContact, indentation_curves, to_problem
from conveyor.laws.resistance import FLEXURE_COEFFICIENT, mean_sag_ratio, sag_flexure_resistance
from conveyor.line.contacts import Contacts, RollResult, integrate_along_rolls
from conveyor.line.covers import belt_backing, roll_contact
from conveyor.line.stretches import Strand
from conveyor.units import si

Array = NDArray[np.float64]

STRETCH_QUADRATURE: Final = tuple(0.5 * column for column in np.polynomial.legendre.leggauss(3))
"""Gauss points along a stretch over half its length, and weights; tension is linear along it."""
_TENSION_MARGIN = 1.1  # range of tension beyond the current one: the iteration moves it by less
_INTERPOLATION_DEGREES = (2, 4, 8, 16, 32)
_CHECKED_LOAD_COUNT = 9  # loads at which interpolation over the tension is checked


@dataclass(frozen=True, eq=False)
class TensionedCurve(IndentationCurve):
    """Indentation of a contact at one tension, interpolated between those solved.

    Order, cost and excited frequencies are those of the nearest solved tension.
    """

    among: TensionedCurves

    @property
    def _weights(self) -> Array:
        backed = self.contact.backing
        return np.zeros(0) if backed is None else self.among.weights(backed.tension)

    @property
    def error(self) -> float:
        """Estimated relative error of the resistance, interpolation over the tension included [-]."""
        return self.among.error

    @property
    def energy_error(self) -> float:
        """Largest energy error of the solved tensions [-]."""
        return max(curve.energy_error for curve in self.solved)

    @property
    def solved(self) -> tuple[IndentationCurve, ...]:
        """Curves at the solved tensions."""
        return self.among.curves

    def resistance(self, line_load: ArrayLike) -> Array:
        """Indentation resistance per width [N/m]."""
        return self._mixed([curve.resistance(line_load) for curve in self.solved])

    def penetration(self, line_load: ArrayLike) -> Array:
        """Penetration of the roll [m]."""
        return self._mixed([curve.penetration(line_load) for curve in self.solved])

    def at(self, line_load: ArrayLike) -> Indentation:
        """Interpolated contact at line loads [N/m]."""
        indentations = [curve.at(line_load) for curve in self.solved]
        peaks = np.array([one.peak_pressure for one in indentations])
        between = interpolation_errors(np.log(peaks.reshape(peaks.shape[0], -1))).max()
        return Indentation(
            line_load=indentations[0].line_load,
            resistance=self._mixed([one.resistance for one in indentations]),
            half_width=self._mixed([one.half_width for one in indentations]),
            eccentricity=self._mixed([one.eccentricity for one in indentations]),
            penetration=self._mixed([one.penetration for one in indentations]),
            peak_pressure=self._mixed(peaks),
            peak_error=np.max([one.peak_error for one in indentations], axis=0) + float(between),
            error=self.error,
            energy_error=self.energy_error,
        )

    def _mixed(self, values: Sequence[Array] | Array) -> Array:
        return np.asarray(np.tensordot(self._weights, np.array(values), axes=1))


@dataclass(frozen=True, eq=False)
class TensionedCurves:
    """Load curves of one contact at points of ln tension, the highest tension first.

    Attributes
    ----------
    curves : tuple of IndentationCurve
        At 2^k + 1 tensions.
    between : float
        Relative interpolation error of the resistance, measured at every other point [-].
    """

    curves: tuple[IndentationCurve, ...]
    between: float

    @property
    def error(self) -> float:
        """Estimated relative error of the resistance at any load and tension [-]."""
        return max(curve.error for curve in self.curves) + self.between

    @cached_property
    def tensions(self) -> Array:
        """Solved tensions per width [N/m]."""
        backings = [curve.contact.backing for curve in self.curves]
        return np.array([behind.tension for behind in backings if behind is not None])

    def weights(self, tension: ArrayLike) -> Array:
        """Weights of the curves at tensions [N/m], shape (*tension.shape, k)."""
        high, low = np.log(self.tensions[[0, -1]])
        t = (2.0 * np.log(tension) - high - low) / (high - low)
        return interpolation_weights(len(self.curves) - 1, t)

    def reaches(self, loads: tuple[float, float], tensions: tuple[float, float]) -> bool:
        """True if the ranges of line load and tension lie within the solved ones [N/m]."""
        first = self.curves[0]
        return (
            first.lowest <= loads[0]
            and loads[1] <= first.highest
            and self.tensions[-1] <= tensions[0]
            and tensions[1] <= self.tensions[0]
        )

    def under(self, tension: float) -> TensionedCurve:
        """The curve at a tension [N/m]."""
        nearest = self.curves[int(np.argmin(np.abs(np.log(self.tensions / tension))))]
        contact = _contact_at_tension(nearest.contact, tension)
        return TensionedCurve(contact, nearest.curve, nearest.lowest, nearest.highest, self)


@dataclass(frozen=True, eq=False)
class BeltContacts(Contacts):
    """Contacts of a line's rolls on a yielding belt; `curves` are at the mean tension of each kind of roll.

    Attributes
    ----------
    pulls : ndarray, shape (2n, 3)
        T - m' V² per width at three points along every stretch [N/m].
    confined : Contacts
        The same rolls on a rigid carcass.
    """

    pulls: Array
    confined: Contacts

    @cached_property
    def rolls(self) -> tuple[tuple[RollResult, ...], ...]:
        """The rolls of one set of every stretch, left to right; each at the mean tension of its stretch."""
        of_kinds, middle = super().rolls, self.pulls @ STRETCH_QUADRATURE[1]
        return tuple(
            tuple(
                replace(roll, curve=_curve_at_tension(roll.curve, pull), rigid_curve=fast.curve, beside=None)
                for roll, fast in zip(rolls, held, strict=True)
            )
            for rolls, held, pull in zip(of_kinds, self.confined.rolls, middle.tolist(), strict=True)
        )

    def deepest(self, strand: Strand) -> float:
        """Largest penetration of the cover alone over its thickness, without the carcass's deflection [-]."""
        return self.confined.deepest(strand)

    @cached_property
    def gives(self) -> tuple[BeltCompliance, ...]:
        """Effect of the yielding carcass on each strand."""
        return tuple(self._give(strand) for strand in ("carry", "return"))

    @cached_property
    def flexure_left_out(self) -> float:
        """Flexure of the belt by the law of load and sag, without that of its bulk [N]; the contacts include it."""
        weight = self.line.gravity
        limits = np.array([stretch.least_tension for stretch in self.line.stretches]) / self.line.belt.width
        middle, half = self.pulls[:, 1], 0.5 * np.diff(self.pulls[:, ::2])[:, 0] / np.ptp(STRETCH_QUADRATURE[0])
        slack = mean_sag_ratio(middle - half, middle + half, limit=limits)
        return math.fsum(
            stretch.sets
            * sag_flexure_resistance(
                stretch.belt_mass * weight * math.cos(stretch.inclination),
                spacing=stretch.spacing,
                relative_sag=share * si(stretch.idlers.sag),
                coefficient=FLEXURE_COEFFICIENT.value,
            )
            for stretch, share in zip(self.line.stretches, slack.tolist(), strict=True)
        )

    def _give(self, strand: Strand) -> BeltCompliance:
        chosen = np.array([stretch.strand == strand for stretch in self.line.stretches])
        forces, pulls = self.indentation[chosen], self.pulls[chosen]
        tension = float(np.average(pulls @ STRETCH_QUADRATURE[1], weights=forces if forces.any() else None))
        kinds = [kind for kind in self.line.kinds if kind.strand == strand]
        most = max(kinds, key=lambda kind: float(kind.sets @ (kind.weights * kind.line_loads)))
        load, cover = self.losing_load(strand), self.covers[strand]
        contact = roll_contact(self.line, most, cover, belt_backing(self.line, cover, tension))
        solution = solve(to_problem(contact, load), self.line.rtol)
        return BeltCompliance(
            strand=strand,
            tensions=(float(pulls.min()), tension, float(pulls.max())),
            line_load=load,
            force=float(forces.sum()),
            confined=float(self.confined.indentation[chosen].sum()),
            shares=solution.loss_shares if _has_loss(contact) else {},
        )


@dataclass(frozen=True)
class BeltCompliance:
    """Effect of the yielding carcass on the indentation of a strand.

    Attributes
    ----------
    strand : {"carry", "return"}
        The strand.
    tensions : tuple of float
        T - m' V² per width: lowest, mean weighted by loss, highest [N/m].
    line_load : float
        Line load of the loss shares [N/m].
    force, confined : float
        Indentation on the yielding belt and on a rigid carcass [N].
    shares : mapping of str to float
        Loss shares: bottom_cover (under the rolls), top_cover (the other), carcass [-]; empty without loss.
    """

    strand: Strand
    tensions: tuple[float, float, float]
    line_load: float
    force: float
    confined: float
    shares: Mapping[str, float]

    @property
    def change(self) -> float:
        """Relative change of indentation against a rigid carcass [-]; 0 without loss."""
        return self.force / self.confined - 1.0 if self.confined > 0.0 else 0.0


_CurveKey: TypeAlias = tuple[RollContact, float]
TensionedCurveCache: TypeAlias = dict[_CurveKey, TensionedCurves]
"""Solved curves by contact at unit tension and tolerance."""


def solve_belt_contacts(
    held: Sequence[Contacts], pulls: Sequence[Array], rtols: Sequence[float], known: TensionedCurveCache
) -> list[BeltContacts | NoSolutionError]:
    """Solve the contacts of many lines on their yielding belts in one batch.

    Parameters
    ----------
    held : sequence of Contacts
        The same contacts on rigid carcasses.
    pulls : sequence of ndarray, shape (2n, 3)
        Of each line T - m' V² per width at the places of `STRETCH_QUADRATURE` along every stretch [N/m], positive.
    rtols : sequence of float
        Relative tolerance of each [-].
    known : dict
        Curves solved before, reused where their ranges suffice; new ones are added.

    Returns
    -------
    list
        Contacts in the order of the lines, or the error.
    """
    keys = [
        [(_contact_at_tension(contact, 1.0), rtol) for contact in _belt_roll_contacts(one)]
        for one, rtol in zip(held, rtols, strict=True)
    ]
    asked: dict[_CurveKey, _LoadTensionRange] = {}
    for one, pull, own in zip(held, pulls, keys, strict=True):
        for key, kind in zip(own, one.line.kinds, strict=True):
            here = pull[[i for i, _ in kind.rolls]]
            span = ((kind.lowest, kind.highest), (float(here.min()), float(here.max())))
            asked[key] = _joint_range(asked.get(key, span), span)
    new = {key: span for key, span in asked.items() if key not in known or not known[key].reaches(*span)}
    solved = _solve_tension_curves({key: _widened_range(known.get(key), span) for key, span in new.items()})
    refused = {key: one for key, one in solved.items() if isinstance(one, NoSolutionError)}
    known.update({key: one for key, one in solved.items() if isinstance(one, TensionedCurves)})
    contacts_of: list[BeltContacts | NoSolutionError] = []
    for one, pull, own in zip(held, pulls, keys, strict=True):
        why = next((refused[key] for key in own if key in refused), None)
        contacts_of.append(_read_belt_contacts(one, pull, [known[key] for key in own]) if why is None else why)
    return contacts_of


_LoadTensionRange: TypeAlias = tuple[tuple[float, float], tuple[float, float]]


def _joint_range(one: _LoadTensionRange, other: _LoadTensionRange) -> _LoadTensionRange:
    (a, b), (c, d) = ((min(x[0], y[0]), max(x[1], y[1])) for x, y in zip(one, other, strict=True))
    return (a, b), (c, d)


def _widened_range(known: TensionedCurves | None, span: _LoadTensionRange) -> _LoadTensionRange:
    """Range with a margin on tension, extended to that solved before."""
    loads, (low, high) = span
    wide = (loads, (low / _TENSION_MARGIN, high * _TENSION_MARGIN))
    if known is None:
        return wide
    first, tensions = known.curves[0], known.tensions
    return _joint_range(wide, ((first.lowest, first.highest), (float(tensions[-1]), float(tensions[0]))))


def _contact_at_tension(contact: RollContact, tension: float) -> RollContact:
    behind = contact.backing
    return contact if behind is None else replace(contact, backing=replace(behind, tension=tension))


def _curve_at_tension(curve: IndentationCurve, tension: float) -> IndentationCurve:
    return curve.among.under(tension) if isinstance(curve, TensionedCurve) else curve


def _belt_roll_contacts(held: Contacts) -> list[RollContact]:
    """Contact of every kind of roll on the yielding belt at unit tension."""
    line, covers = held.line, held.covers
    behind = {strand: belt_backing(line, cover, 1.0) for strand, cover in covers.items()}
    return [roll_contact(line, kind, covers[kind.strand], behind[kind.strand]) for kind in line.kinds]


def _solve_tension_curves(
    spans: Mapping[_CurveKey, _LoadTensionRange],
) -> dict[_CurveKey, TensionedCurves | NoSolutionError]:
    """Solve at ever more tensions until interpolation meets the tolerance; all contacts in one batch."""
    curves_of: dict[_CurveKey, TensionedCurves | NoSolutionError] = {}
    curves: dict[_CurveKey, list[IndentationCurve]] = {key: [] for key in spans}
    for degree in _INTERPOLATION_DEGREES:
        jobs: dict[float, list[tuple[_CurveKey, int, RollContact]]] = {}
        for key in curves.keys() - curves_of.keys():
            middle, half = (0.5 * np.log(spans[key][1]) @ pair for pair in ((1.0, 1.0), (-1.0, 1.0)))
            for j in range(degree + 1) if degree == _INTERPOLATION_DEGREES[0] else range(1, degree, 2):
                contact = _contact_at_tension(key[0], float(np.exp(middle + half * lobatto_points(degree)[j])))
                jobs.setdefault(key[1], []).append((key, j, contact))
        for rtol, asked in jobs.items():
            lowest, highest = zip(*(spans[key][0] for key, _, _ in asked), strict=True)
            answers = indentation_curves([contact for _, _, contact in asked], lowest, highest, 0.5 * rtol)
            for (key, j, _), answer in zip(asked, answers, strict=True):
                if isinstance(answer, NoSolutionError):
                    curves_of.setdefault(key, answer)
                else:
                    curves[key].insert(j, answer)
        for key in curves.keys() - curves_of.keys():
            if (
                enough := _accept_interpolation(
                    curves[key], spans[key], key[1], last=degree == _INTERPOLATION_DEGREES[-1]
                )
            ) is not None:
                curves_of[key] = enough
    return curves_of


def _accept_interpolation(
    curves: Sequence[IndentationCurve], span: _LoadTensionRange, rtol: float, *, last: bool
) -> TensionedCurves | NoSolutionError | None:
    """Curves with their interpolation error; None where more tensions are needed, an error after the last."""
    left = 0.0
    if _has_loss(curves[0].contact):
        loads = np.geomspace(*span[0], _CHECKED_LOAD_COUNT)
        left = float(interpolation_errors(np.log([curve.resistance(loads) for curve in curves])).max())
    if left <= 0.5 * rtol:
        return TensionedCurves(tuple(curves), left)
    if not last:
        return None
    low, high = span[1]
    return NoSolutionError(
        f"between tensions of {{}} and {{}} the indentation is not known better than to {left:.1e} from {len(curves)} "
        "of them: give calculation.rtol a larger value",
        MessageQuantity(low, "line force", f"{low:.4g}"),
        MessageQuantity(high, "line force", f"{high:.4g} N/m"),
    )


def _has_loss(contact: RollContact) -> bool:
    behind = contact.backing
    inside = behind is not None and (behind.series.moduli.size > 0 or behind.bending * behind.bending_loss > 0.0)
    return inside or contact.series.moduli.size > 0


def _read_belt_contacts(held: Contacts, pulls: Array, families: Sequence[TensionedCurves]) -> BeltContacts:
    """Resistance of every roll at the tensions of its stretch."""
    line, covers = held.line, held.covers
    curves, resistances = [], []
    for kind, family in zip(line.kinds, families, strict=True):
        here = pulls[[i for i, _ in kind.rolls]]
        middle = float((here @ STRETCH_QUADRATURE[1]).mean())
        curves.append(family.under(middle))
        resistance = np.array([curve.resistance(kind.distinct) for curve in family.curves])
        tested = covers[kind.strand].test_factor
        if tested is not None:
            resistance = resistance * tested.factor(kind.distinct)
        weights = (family.weights(here) * STRETCH_QUADRATURE[1][:, None]).sum(axis=1)
        of_roll = np.repeat(weights, np.diff([*kind.starts, kind.which.size]), axis=0)
        resistances.append(integrate_along_rolls(kind, (of_roll * resistance.T[kind.which]).sum(axis=1)))
    return BeltContacts(line, covers, tuple(curves), tuple(resistances), pulls, held)
