"""Contacts that need not be solved apart: spacings and rubber terms of no influence."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

from conveyor.indentation.roll_contact import RollContact

SPACING_INFLUENCE = 4.0
"""Factor of (h/λ)³, the relative influence of the spacing on friction: at most 1.8 (h/λ)³ was seen on the shelf's
rubbers (λ/h 25 to 800, 0.5 and 8 m/s, -27 to 77 °C)."""


def merge_equal_contacts(contacts: Iterable[RollContact], rtol: float) -> dict[RollContact, RollContact]:
    """Contact to solve for each contact: those that differ in spacing only share the closest, where rtol allows.

    Parameters
    ----------
    contacts : iterable of RollContact
        Contacts of one conveyor.
    rtol : float
        Relative error allowed [-]; spacings that change friction by more, by 4 (h/λ)³, are kept apart.

    Returns
    -------
    dict
        Representative of every contact: itself, or the one of the closest spacing.
    """
    alike: dict[RollContact, list[RollContact]] = {}
    for contact in contacts:
        alike.setdefault(replace(contact, spacing=1.0), []).append(contact)
    first = {}
    for members in alike.values():
        closest = min(members, key=lambda contact: contact.spacing)
        shared = closest.support == "confined" and closest.poisson == 0.5 and spacing_error(closest) <= rtol
        first.update({contact: closest if shared else contact for contact in members})
    return first


def spacing_error(contact: RollContact) -> float:
    """Relative change of a confined contact's friction at a larger roll spacing, an upper estimate [-]."""
    return SPACING_INFLUENCE * (contact.cover_thickness / contact.spacing) ** 3


FAST_TERMS_INFLUENCE, SLOW_TERMS_INFLUENCE = 2.0, 0.1
"""Factors of (V τ/a)^1.5 and (h/(V τ))²: relative change of friction as all terms faster, all slower than τ are
merged. At most 1.03 and 0.044 were seen on four compounds of the shelf (-30 to 50 °C, 0.5 to 9 m/s, 0.1 to 10 N/mm,
2.5 to 16 mm, rolls of 60 to 240 mm)."""


def resolved_relaxation_times(contact: RollContact, line_load: float, error: float) -> tuple[float, float]:
    """Relaxation times between which a roll resolves the terms of its rubber [s].

    Parameters
    ----------
    contact : RollContact
        Confined, of an incompressible cover.
    line_load : float
        w, the least that occurs [N/m].
    error : float
        Relative change of friction allowed [-] for merging the terms beyond either time.

    Returns
    -------
    tuple of float
        Fastest, slowest; a is Hertz' half width at the storage modulus of ω = V/a∞, a∞ that at the glassy modulus.
    """
    series, speed = contact.series, contact.speed
    unit = 4.0 * (1.0 - contact.poisson**2) * line_load * contact.radius / math.pi
    narrow = math.sqrt(unit / series.glassy)
    narrow = math.sqrt(unit / float(series.storage(speed / narrow)))
    fastest = (error / FAST_TERMS_INFLUENCE) ** (2.0 / 3.0) * narrow / speed
    return fastest, math.sqrt(SLOW_TERMS_INFLUENCE / error) * contact.cover_thickness / speed


def coarsen_rubber(contact: RollContact, line_load: float, error: float) -> RollContact:
    """Merge the rubber terms that the roll does not resolve; only of a confined, incompressible cover.

    Parameters
    ----------
    contact : RollContact
        Roll, cover and rubber.
    line_load : float
        w, the least that occurs [N/m].
    error : float
        As in `resolved_relaxation_times`, for the fast and for the slow terms each [-].
    """
    if contact.support != "confined" or contact.poisson != 0.5:
        return contact
    fastest, slowest = resolved_relaxation_times(contact, line_load, error)
    return replace(contact, series=contact.series.merged(fastest=fastest, slowest=slowest))
