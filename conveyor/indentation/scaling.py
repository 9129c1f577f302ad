"""Dimensionless problem of a roll under a belt.

Scales (paper, section 3): k = 2π/λ with λ the idler spacing, E0 the rubbery modulus,

    p̃_m = 2(1-ν²) p_m/(E0 k R) = (1-ν²) w/(π E0 R)   (p_m = w/λ),      ζ_t = V τ_t k,      μ = f/w.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from conveyor.contact import Belt, ContactProblem, CreepSpectrum
from conveyor.indentation.roll_contact import Backing, RollContact
from conveyor.rubber import CreepSeries, creep_forms


def to_problem(contact: RollContact, line_load: float) -> ContactProblem:
    """Dimensionless problem of a roll under a line load.

    Parameters
    ----------
    contact : RollContact
        Roll, cover, speed and rubber.
    line_load : float
        w, load per width [N/m].

    Returns
    -------
    ContactProblem
        With the creep spectrum of the rubber, normalised by E0.

    Raises
    ------
    InputError
        A value outside what the contact allows, e.g. rolls that overlap.
    """
    return to_problems([contact], [line_load])[0]


def to_problems(contacts: Sequence[RollContact], line_loads: Sequence[float]) -> list[ContactProblem]:
    """Dimensionless problems of many rolls, each as `to_problem`; their spectra are inverted in a batch.

    Parameters
    ----------
    contacts : sequence of RollContact
        Rolls, covers, speeds and rubbers.
    line_loads : sequence of float
        Line load w of each [N/m].

    Raises
    ------
    InputError
        As `to_problem`.
    """
    behind = [contact.backing.series for contact in contacts if contact.backing is not None]
    rubbers = dict.fromkeys([*(contact.series for contact in contacts), *behind])
    creep_of = dict(zip(rubbers, creep_forms(rubbers), strict=True))
    problems = []
    for contact, line_load in zip(contacts, line_loads, strict=True):
        k = 2.0 * math.pi / contact.spacing
        rubbery = contact.series.equilibrium
        problems.append(
            ContactProblem(
                support=contact.support
                if contact.backing is None
                else _dimensionless_belt(contact, contact.backing, creep_of[contact.backing.series]),
                radius=contact.radius / contact.spacing,
                pressure=(1.0 - contact.poisson**2) * line_load / (math.pi * rubbery * contact.radius),
                creep=_normalised_creep(creep_of[contact.series], rubbery, contact.speed * k),
                thickness=math.inf if contact.support == "half-space" else k * contact.cover_thickness,
                poisson=contact.poisson,
            )
        )
    return problems


def _normalised_creep(creep: CreepSeries, rubbery: float, rate: float) -> CreepSpectrum:
    """Creep over 1/E0, times over 1/(V k)."""
    return CreepSpectrum(
        instantaneous=rubbery * creep.instantaneous,
        weights=rubbery * creep.compliances,
        times=creep.times * rate,
    )


def _dimensionless_belt(contact: RollContact, behind: Backing, creep: CreepSeries) -> Belt:
    """Dimensionless belt: tension T k/E0, bending D k³/E0, in-plane stiffness K k/E0."""
    k, rubbery = 2.0 * math.pi / contact.spacing, contact.series.equilibrium
    bending = behind.bending * k**3 / rubbery
    return Belt(
        bottom=k * contact.cover_thickness,
        top=k * behind.cover_thickness,
        top_creep=_normalised_creep(creep, behind.series.equilibrium, contact.speed * k),
        top_modulus=behind.series.equilibrium / rubbery,
        tension=behind.tension * k / rubbery,
        bending=complex(bending, bending * behind.bending_loss),
        stretching=behind.stretching * k / rubbery,
    )
