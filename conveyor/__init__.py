"""Belt-conveyor power from the viscoelastic rolling contact of every idler roll.

Examples
--------
>>> import conveyor
>>> line = conveyor.load("examples/specs/overland.yaml")  # doctest: +SKIP
>>> result = conveyor.analyse(line)  # doctest: +SKIP
>>> result.to_excel("overland.xlsx")  # doctest: +SKIP
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from conveyor.errors import (
        ConveyorError,
        InputError,
        NoSolutionError,
        RangeError,
        SpecError,
        ValidityWarning,
    )
    from conveyor.models import Conveyor, MeasuredRun, RubberCompound
    from conveyor.models.cases import LoadCase
    from conveyor.models.sizing import SizingDuty
    from conveyor.models.study import StudyPlan
    from conveyor.results.analysis import (
        Analysis,
        CaseStudy,
        DutyStudy,
        Studies,
        analyse,
        analyse_cases,
        analyse_duty,
        analyse_studies,
    )
    from conveyor.results.comparisons import (
        CalibrationStudy,
        Comparison,
        VerificationSheet,
        calibrate,
        compare,
        compare_compounds,
        verify_sheet,
    )
    from conveyor.results.designs import Sizing, Study, size, study
    from conveyor.spec import load

    __version__: str

# Imported on first use: `conveyor --help` must not pay for scipy and pandas.
_WHERE = {
    "conveyor.results.comparisons": (
        "CalibrationStudy",
        "Comparison",
        "VerificationSheet",
        "calibrate",
        "compare",
        "compare_compounds",
        "verify_sheet",
    ),
    "conveyor.results.designs": ("Sizing", "Study", "size", "study"),
    "conveyor.errors": (
        "ConveyorError",
        "InputError",
        "NoSolutionError",
        "RangeError",
        "SpecError",
        "ValidityWarning",
    ),
    "conveyor.models": ("Conveyor", "MeasuredRun", "RubberCompound"),
    "conveyor.models.cases": ("LoadCase",),
    "conveyor.models.sizing": ("SizingDuty",),
    "conveyor.models.study": ("StudyPlan",),
    "conveyor.spec": ("load",),
}
"""Modules of names; `conveyor.results.analysis` has the others."""

__all__ = [
    "Analysis",
    "CalibrationStudy",
    "CaseStudy",
    "Comparison",
    "Conveyor",
    "ConveyorError",
    "DutyStudy",
    "InputError",
    "LoadCase",
    "MeasuredRun",
    "NoSolutionError",
    "RangeError",
    "RubberCompound",
    "Sizing",
    "SizingDuty",
    "SpecError",
    "Studies",
    "Study",
    "StudyPlan",
    "ValidityWarning",
    "VerificationSheet",
    "__version__",
    "analyse",
    "analyse_cases",
    "analyse_duty",
    "analyse_studies",
    "calibrate",
    "compare",
    "compare_compounds",
    "load",
    "size",
    "study",
    "verify_sheet",
]


# So are the modules that users reach as attributes.
_MODULES = {
    **{
        name: f"conveyor.{name}"
        for name in ("contact", "indentation", "rubber", "shelf", "spec", "studies", "uncertainty", "units")
    },
    "libraries": "conveyor.files.libraries",
}


def __dir__() -> list[str]:
    return sorted({*__all__, *_MODULES})


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return import_module("importlib.metadata").version("conveyor")
    if name in __all__:
        module = next((module for module, names in _WHERE.items() if name in names), "conveyor.results.analysis")
        return getattr(import_module(module), name)
    if name in _MODULES:
        return import_module(_MODULES[name])
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
