"""The rules of the house (CONTRIBUTING.md), read off the code itself."""

from __future__ import annotations

import ast
import collections
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "conveyor"
FILES = {
    ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): path
    for path in sorted(PACKAGE.rglob("*.py"))
    if "_materials" not in path.parts
}
SOURCES = {name: path.read_text(encoding="utf-8") for name, path in FILES.items()}
TREES = {name: ast.parse(text) for name, text in SOURCES.items()}


def inside(*packages: str) -> dict[str, str]:
    """Sources of packages."""
    return {
        name: text
        for name, text in SOURCES.items()
        if any(name == package or name.startswith(f"{package}.") for package in packages)
    }


def imports(name: str) -> set[str]:
    """Modules of the package that one imports, at its top, inside functions or for types only."""
    found = set()
    for node in ast.walk(TREES[name]):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("conveyor"):
            for alias in node.names:
                below = f"{node.module}.{alias.name}"
                found.add(below if below in FILES else node.module)
        elif isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names if alias.name in FILES}
    return found & set(FILES)


def test_no_circle_of_imports():
    """Also none tied by an import inside a function, or for types only."""
    left = {name: imports(name) - {name} for name in FILES}
    while free := {name for name, needed in left.items() if not needed & set(left)}:
        left = {name: needed for name, needed in left.items() if name not in free}
    # what is left is in a circle or imports one: strip those that nothing left imports
    while idle := set(left) - set().union(*left.values()):
        left = {name: needed for name, needed in left.items() if name not in idle}
    assert sorted(left) == []


def test_no_file_is_longer_than_500_lines():
    """A file holds one subject; what grows beyond is two."""
    assert {name: n for name, text in SOURCES.items() if (n := text.count("\n")) > 500} == {}


def test_quantities_end_in_models_and_line():
    at_home = ("conveyor.models", "conveyor.line", "conveyor.sizing.sizing_task", "conveyor.units")
    others = {name for name, text in SOURCES.items() if re.search(r"(?<!def )\bsi\(", text)}
    assert sorted(others - set(inside(*at_home))) == []


def test_labels_hold_no_units():
    """A unit is put beside a label in one place; nobody reads it off again."""
    written = re.compile(r"""["'][^"'\n]* \[[A-Za-z°%µ²³/()\- ]+\]["']""")
    found = [
        (name, match[0])
        for name, text in inside("conveyor.report", "conveyor.cli", "conveyor.studies").items()
        if name != "conveyor.studies.study_file"  # says how users head a column
        for match in written.finditer(_without_docstrings(name, text))
    ]
    assert found == []


def _without_docstrings(name: str, text: str) -> str:
    lines = text.split("\n")
    for node in ast.walk(TREES[name]):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            for i in range(node.lineno - 1, node.end_lineno or node.lineno):
                lines[i] = ""
    return "\n".join(lines)


RENDERERS = (
    "cells",
    "charts",
    "summary_sheet",
    "excel",
    "table_files",
    "html",
    "page_elements",
    "sheet_writer",
    "sheets",
)


@pytest.mark.parametrize("renderer", RENDERERS)
def test_renderers_know_no_results(renderer):
    name = f"conveyor.report.{renderer}"
    below = (
        "conveyor.line",
        "conveyor.loop",
        "conveyor.studies",
        "conveyor.pipeline",
        "conveyor.results.analysis",
        "conveyor.results.comparisons",
    )
    assert name in FILES
    assert [used for used in sorted(imports(name)) if used.startswith(below)] == []


def test_nothing_is_kept_by_its_identity():
    """`id()` is an object's only while it lives: no key."""
    assert [name for name, text in SOURCES.items() if re.search(r"(?<![\w.])id\(", text)] == []


def test_public_class_names_stand_once():
    where = collections.defaultdict(list)
    for name, tree in TREES.items():
        for node in ast.walk(tree):
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                where[node.name].append(name)
    assert {cls: names for cls, names in where.items() if len(names) > 1} == {}


def test_a_public_law_has_a_caller_or_a_validation():
    """Else nobody knows whether it is right, and nobody misses it."""
    validations = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "tests" / "validation").glob("*.py"))
    idle = []
    for name, tree in TREES.items():
        if not name.startswith("conveyor.laws"):
            continue
        others = "\n".join(
            text for other, text in SOURCES.items() if other != name and FILES[other].name != "__init__.py"
        )
        own = SOURCES[name]
        for node in tree.body:
            if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
                word = re.compile(rf"\b{node.name}\b")
                called_here = re.search(rf"(?<!def )(?<!>>> )\b{node.name}\(", _without_docstrings(name, own))
                if not (word.search(others) or word.search(validations) or called_here):
                    idle.append(f"{name}.{node.name}")
    assert idle == []
