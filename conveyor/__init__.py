"""Belt-conveyor power from the viscoelastic rolling contact of every idler roll.

>>> import conveyor
>>> line = conveyor.load("examples/specs/overland.yaml")  # doctest: +SKIP
>>> result = conveyor.analyse(line)  # doctest: +SKIP
>>> result.to_excel("overland.xlsx")  # doctest: +SKIP
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from conveyor.analysis import Analysis, analyse
    from conveyor.errors import ConveyorError, InputError, NoSolutionError, RangeError, ValidityWarning
    from conveyor.models import Conveyor, RubberCompound
    from conveyor.spec import load
    from conveyor.studies.cases import CaseStudy, analyse_cases
    from conveyor.studies.comparison import Comparison, compare, compare_compounds
    from conveyor.studies.duty import DutyStudy, analyse_duty

    __version__: str

# Imported on first use: `conveyor --help` must not pay for scipy and pandas.
_WHERE = {
    "Analysis": "conveyor.analysis",
    "CaseStudy": "conveyor.studies.cases",
    "Comparison": "conveyor.studies.comparison",
    "Conveyor": "conveyor.models",
    "ConveyorError": "conveyor.errors",
    "DutyStudy": "conveyor.studies.duty",
    "InputError": "conveyor.errors",
    "NoSolutionError": "conveyor.errors",
    "RangeError": "conveyor.errors",
    "RubberCompound": "conveyor.models",
    "ValidityWarning": "conveyor.errors",
    "analyse": "conveyor.analysis",
    "analyse_cases": "conveyor.studies.cases",
    "analyse_duty": "conveyor.studies.duty",
    "compare": "conveyor.studies.comparison",
    "compare_compounds": "conveyor.studies.comparison",
    "load": "conveyor.spec",
}

__all__ = [
    "Analysis",
    "CaseStudy",
    "Comparison",
    "Conveyor",
    "ConveyorError",
    "DutyStudy",
    "InputError",
    "NoSolutionError",
    "RangeError",
    "RubberCompound",
    "ValidityWarning",
    "__version__",
    "analyse",
    "analyse_cases",
    "analyse_duty",
    "compare",
    "compare_compounds",
    "load",
]


# So are the modules that users reach as attributes.
_MODULES = {
    **{
        name: f"conveyor.{name}"
        for name in ("contact", "indentation", "rubber", "shelf", "spec", "studies", "units")
    },
    "libraries": "conveyor.files.libraries",
    "uncertainty": "conveyor.studies.uncertainty",
}


def __dir__() -> list[str]:
    return sorted({*__all__, *_MODULES})


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return import_module("importlib.metadata").version("conveyor")
    if name in _WHERE:
        return getattr(import_module(_WHERE[name]), name)
    if name in _MODULES:
        return import_module(_MODULES[name])
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
