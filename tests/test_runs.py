"""Tables of measured runs: as people write them, and refused by their place where they are doubtful."""

from __future__ import annotations

from pathlib import Path

import openpyxl
import pytest

from conveyor.errors import InputError
from conveyor.measured.run_table import read_runs
from conveyor.models import MeasuredRun


def table(folder: Path, *lines: str, name: str = "runs.csv") -> Path:
    path = folder / name
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def figures(run: MeasuredRun) -> tuple[float | str | None, ...]:
    return (
        run.watts,
        run.at,
        run.mass_flow,
        run.belt_speed,
        run.belt_temperature,
        run.deviation_watts,
        run.note,
    )


def test_units_stand_in_the_headers(tmp_path: Path):
    path = table(
        tmp_path,
        "# week 14",
        "Motor power [kW],Flow (t/h),belt speed [m/s],temperature [degC],standard deviation [%],note",
        "250,0,5,20,2,empty",
        "812.5,3600,5,20,2,",
    )
    empty, full = read_runs(path)
    assert figures(empty) == pytest.approx((250e3, "motor shaft", 0.0, 5.0, 293.15, 5e3, "empty"))
    assert figures(full) == pytest.approx((812.5e3, "motor shaft", 1000.0, 5.0, 293.15, 16.25e3, ""))


def test_us_units_and_either_place(tmp_path: Path):
    path = table(
        tmp_path,
        "motor power [hp];mains power [kW];flow [stph];temperature [degF]",
        "100;;0;68",
        ";80,5;1000;32",
    )
    first, second = read_runs(path)
    assert (first.at, second.at) == ("motor shaft", "mains")
    assert first.watts == pytest.approx(74569.987, rel=1e-7)  # 550 ft lbf/s
    assert second.watts == pytest.approx(80.5e3)  # a decimal comma
    assert second.mass_flow == pytest.approx(1000 * 907.18474 / 3600)
    assert (first.belt_temperature, second.belt_temperature) == pytest.approx((293.15, 273.15))


def test_cells_may_carry_their_units(tmp_path: Path):
    (run,) = read_runs(table(tmp_path, "motor power,flow,air temperature,temperature", "0.2 MW,500 kg/s,5 degC,8 degC"))
    assert (run.watts, run.mass_flow) == pytest.approx((2e5, 500.0))
    assert run.state[3] == pytest.approx(278.15)


def test_a_workbook_is_read_as_text_is(tmp_path: Path):
    book = openpyxl.Workbook()
    for row in (("motor power [kW]", "flow [t/h]", "note: shift"), (250, 0, None), (812.5, 3600, "late")):
        book.active.append(row)
    book.save(tmp_path / "runs.xlsx")
    read = read_runs(tmp_path / "runs.xlsx")
    assert [run.watts for run in read] == pytest.approx([250e3, 812.5e3])
    assert [run.note for run in read] == ["", "late"]


@pytest.mark.parametrize(
    "title",
    [["Power log of CV-01", ""], ["CV-01;power;2025", "measured by;A. Meter"], ["CV-01, power, 3 May 2025"]],
)
def test_a_title_may_stand_above(tmp_path: Path, title: list[str]):
    path = table(tmp_path, *title, "motor power [kW];flow [t/h]", "250,5;0", "812,5;3600")
    assert [run.watts for run in read_runs(path)] == pytest.approx([250.5e3, 812.5e3])


HEAD = "motor power [kW],flow [t/h]"


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ([HEAD], r"no run in it; the first line names columns"),
        (["power [kW],flow [t/h]", "1,2"], r'runs.csv:1: column 1 "power \[kW\]": not known; allowed: motor'),
        ([f"date,{HEAD},amps", "1,2,3,4"], r'1 "date": not known, nor "amps"; allowed: .*begin a name with'),
        (["motor power [kW],note", "1,2"], r"runs.csv:1: column 1: no column flow"),
        (["flow [t/h],note", "1,2"], r"no column motor power \[kW\] or mains power \[kW\]"),
        ([f"{HEAD},mass flow [t/h]", "1,2,3"], r'column 3 "mass flow \[t/h\]": the row has a flow and a mass flow'),
        ([HEAD, "250,0", "abc,1"], r"runs.csv:3: column 1 .*'abc' is not a number"),
        ([HEAD, "250,"], r"runs.csv:2: column 2: flow \[t/h\], 0 where empty is missing in the row"),
        ([HEAD, ",100"], r"runs.csv:2: column 1: motor power \[kW\] or mains power \[kW\] is missing"),
        ([HEAD, "250,-5"], r"runs.csv:2: flow: got -5 t/h, allowed: >= 0 t/h"),
        ([f"{HEAD},standard deviation [%]", "250,1,200"], r'3 "standard deviation \[%\]": got 200 % of the power'),
        ([f"{HEAD},standard deviation [kW]", "250,1,300"], r"runs.csv:2: deviation: got 300 kW of a power of 250 kW"),
        ([HEAD, "250,1,7"], r"runs.csv:2: column 3: a cell beyond the last header"),
        (["motor power [bar],flow [t/h]", "250,1"], r'column 1 "motor power \[bar\]": got "250 bar"'),
        (["motor power,flow [t/h]", "250,1"], r"column 1 .*got \"?250\"?"),
        (["motor power [kW],mains power [kW],flow [t/h]", "1,2,3"], "the row has a motor power and a mains power"),
        ([f"{HEAD},air temperature [degC]", "250,1,7"], r"temperature: missing: give the belt's temperature"),
        (["motor power [kW];flow [t/h]", "1,234;2"], "may have a decimal comma or one between thousands"),
        ([HEAD, *["250,0"] * 1001], "1001 rows, at most 1000"),
    ],
)  # fmt: skip
def test_what_is_doubtful_is_refused_by_its_place(tmp_path: Path, lines: list[str], said: str):
    with pytest.raises(InputError, match=said):
        read_runs(table(tmp_path, *lines))


def test_no_such_file_and_several_sheets(tmp_path: Path):
    with pytest.raises(InputError, match="no such file"):
        read_runs(tmp_path / "none.csv")
    book = openpyxl.Workbook()
    book.active.append(("motor power [kW]",))
    book.create_sheet().append(("flow [t/h]",))
    book.save(tmp_path / "two.xlsx")
    with pytest.raises(InputError, match="2 sheets hold cells; keep the runs on one"):
        read_runs(tmp_path / "two.xlsx")
