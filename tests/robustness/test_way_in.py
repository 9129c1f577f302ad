"""Every case of the table: one clear message with its place, the exit code, nothing half-written."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.robustness.arrange import Case
from tests.robustness.cases import CASES
from tests.robustness.table import Outcome, recorded, row, run

_BY_OTHERS = {"output", "command line"}
"""Groups whose words belong to the options of each command: the table has their rows, cases.py the heart of them."""
_BY_PYTHON = {"JSON: a comma too many"}
"""Python 3.13 points at the comma itself, earlier ones behind it."""
_PLACED = {"YAML", "encoding", "JSON", "value", "field", "contradiction"}
"""Groups whose every line names file, line and column."""
_JARGON = re.compile(r"Traceback|pydantic|ValidationError|<class|0x[0-9a-f]{6,}|NoneType|object at|Errno")


def _kinds(outcome: Outcome) -> set[str]:
    return {name for name, content in outcome.after.items() if content is None}


@pytest.fixture(scope="module")
def rows() -> dict[str, str]:
    return recorded()


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_one_clear_message_its_exit_code_and_no_file_changed(case: Case, tmp_path: Path, rows: dict[str, str]) -> None:
    outcome = run(case, tmp_path)
    said = outcome.err.strip().splitlines()
    assert outcome.code == case.code, outcome.err
    assert case.says in outcome.err
    assert len(said) == case.lines, outcome.err
    assert _JARGON.search(outcome.err) is None, outcome.err
    assert outcome.out == ""
    assert outcome.after == outcome.before  # an older file untouched, no *.part, nothing new
    assert not re.search(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e]", outcome.err)
    if case.group in _PLACED:
        placed = re.compile(r"(?:spec\.(?:yaml|json):[0-9]+:[0-9]+ \S+: |spec\.yaml: larger than )")
        assert all(placed.match(line) for line in said), outcome.err
    if case.group not in _BY_OTHERS and case.name not in _BY_PYTHON:
        assert rows[case.name] == row(case, outcome), "write table.md anew: python -m tests.robustness.table"


def test_the_table_has_every_case_once_with_its_exit_code(rows: dict[str, str]) -> None:
    names = [case.name for case in CASES]
    assert len(names) == len(set(names)) > 60
    assert list(rows) == names, "write table.md anew: python -m tests.robustness.table"
    for case in CASES:
        assert rows[case.name].endswith(f" | {case.code} |")
        assert "`` " in rows[case.name]  # says something


def test_what_the_outcome_compares_can_tell_a_change(tmp_path: Path) -> None:
    """The comparison of files before and after sees contents, new files and files that went."""
    given = Case("self", "starter", lambda _: ("new", "mine.yaml", "-q"), "", code=0)
    outcome = run(given, tmp_path)
    assert (outcome.code, outcome.err) == (0, "")
    assert set(outcome.after) - set(outcome.before) == {"mine.yaml"}
    assert _kinds(outcome) == set()
