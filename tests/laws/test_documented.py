"""Every public law documents every argument, in order, with a unit, and says what it raises."""

from __future__ import annotations

import inspect
import pkgutil
import re
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from conveyor import laws
from conveyor.contact import closed_forms

WITHOUT_UNIT = {"minima", "carcass"}  # a mapping whose text states the unit; a name


def _modules() -> Iterator[ModuleType]:
    """Every module of the laws and of the closed forms of contacts, as they are found."""
    for package in (laws, closed_forms):
        for found in pkgutil.walk_packages(package.__path__, package.__name__ + "."):
            yield import_module(found.name)


def _public(module: ModuleType) -> Iterator[tuple[str, Callable[..., Any]]]:
    """Public functions that a module defines itself."""
    for name, law in vars(module).items():
        if inspect.isfunction(law) and not name.startswith("_") and law.__module__ == module.__name__:
            yield name, law


LAWS = [pytest.param(law, id=f"{module.__name__}.{name}") for module in _modules() for name, law in _public(module)]


def test_every_file_is_looked_into() -> None:
    folders = (Path(package.__path__[0]) for package in (laws, closed_forms))
    files = {path.stem for folder in folders for path in folder.rglob("*.py")} - {"__init__"}
    assert {module.__name__.rpartition(".")[2] for module in _modules()} >= files
    assert len(files) > 30


@pytest.mark.parametrize("law", LAWS)
def test_arguments_are_documented_in_order_with_units(law: Callable[..., Any]) -> None:
    doc = inspect.getdoc(law) or ""
    section = doc.split("Parameters\n----------\n")[1].split("\n\n")[0]
    documented = re.findall(r"^(\*?\w+(?:, \*?\w+)*) : .*\n((?:    .*\n?)+)", section, re.MULTILINE)
    names = [name.strip("*") for heading, _ in documented for name in heading.split(", ")]
    assert names == list(inspect.signature(law).parameters)
    for heading, text in documented:
        for name in heading.split(", "):
            assert name in WITHOUT_UNIT or re.search(r"\[[^\]]+\]", text), name


@pytest.mark.parametrize("law", LAWS)
def test_result_refusal_and_example_are_documented(law: Callable[..., Any]) -> None:
    doc = inspect.getdoc(law) or ""
    for heading in ("Returns\n-------", "Raises\n------", "Examples\n--------"):
        assert heading in doc
