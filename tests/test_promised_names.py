"""What docs/versions.md promises: a name of the last release is still there, and a newer format is refused in words."""

from __future__ import annotations

from pathlib import Path

import pytest

from conveyor.errors import InputError
from conveyor.spec import from_data, load
from tests.promised_names import promised, today

SPECS = Path(__file__).parent.parent / "examples" / "specs"


def test_no_promised_name_is_gone() -> None:
    gone = sorted(set(promised()) - set(today()))
    assert gone == [], (
        "these names of the last release are gone: bring them back, or keep them for one minor version with a warning "
        "(docs/versions.md); before a release `python -m tests.promised_names` writes the list anew"
    )


def test_the_list_has_every_kind_of_name() -> None:
    known = set(promised())
    assert {
        "python conveyor.analyse(conveyor)",
        "python conveyor.compare(progress) may be left out",
        "python conveyor.Analysis.to_excel(path)",
        "spec belt.width",
        "spec calculation.method: din 22101",
        "spec route.sections[].lift may be left out",
        "compound prony.terms[].time",
        "json power power_kW motor",
        "json power checks[] verdict",
        "sheet Results, table results",
        "table results: `motor_power`",
        "command conveyor power --tables",
    } <= known
    assert "spec belt.width may be left out" not in known


def test_a_spec_may_state_its_format_and_a_newer_one_is_refused() -> None:
    data = load(SPECS / "overland.yaml").as_data()
    assert data["conveyor"] == 1
    without = {key: value for key, value in data.items() if key != "conveyor"}
    assert from_data(without) == from_data(data)
    with pytest.raises(InputError, match=r"conveyor: got 2, this version of conveyor reads 1; the spec is of a newer"):
        from_data(data | {"conveyor": 2})
    with pytest.raises(InputError, match="conveyor: expected a whole number"):
        from_data(data | {"conveyor": "1.0"})
