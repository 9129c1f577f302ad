"""The one bridge between SI and the dimensionless contact: a roll under a belt, its solution, its softening rubber."""

from conveyor.indentation.contact_reduction import (
    SPACING_INFLUENCE,
    coarsen_rubber,
    merge_equal_contacts,
    resolved_relaxation_times,
    spacing_error,
)
from conveyor.indentation.indentation_results import (
    Indentation,
    IndentationCurve,
    curve_resistances,
    indentation_curve,
    indentation_curves,
    indentation_resistance,
    indentation_resistances,
)
from conveyor.indentation.roll_contact import Backing, RollContact, Support
from conveyor.indentation.scaling import to_problem, to_problems

__all__ = [
    "SPACING_INFLUENCE",
    "Backing",
    "Indentation",
    "IndentationCurve",
    "RollContact",
    "Support",
    "coarsen_rubber",
    "curve_resistances",
    "indentation_curve",
    "indentation_curves",
    "indentation_resistance",
    "indentation_resistances",
    "merge_equal_contacts",
    "resolved_relaxation_times",
    "spacing_error",
    "to_problem",
    "to_problems",
]
