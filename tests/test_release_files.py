"""Files that state the version and what the package needs agree with pyproject.toml."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parent.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def test_the_version_is_the_same_everywhere() -> None:
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    recipe = (ROOT / "recipe" / "recipe.yaml").read_text(encoding="utf-8")
    assert re.findall(r'^\s*version: "?([\d.a-z]+)"?$', citation + recipe, re.MULTILINE) == [PROJECT["version"]] * 2


def test_the_recipe_needs_what_the_package_needs() -> None:
    recipe = (ROOT / "recipe" / "recipe.yaml").read_text(encoding="utf-8")
    run = recipe.partition("  run:\n")[2].partition("tests:")[0]
    needed = {line.strip().removeprefix("- ").replace("matplotlib-base", "matplotlib") for line in run.splitlines()}
    expected = {re.sub(r"(?=>=)", " ", line) for line in PROJECT["dependencies"]}
    assert needed - {""} == {f"python {PROJECT['requires-python']}", *expected}
