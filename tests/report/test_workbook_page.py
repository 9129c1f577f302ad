"""docs/workbook.md against the workbooks: every sheet, table, column, kind and name is in it, and nothing else."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

import conveyor
from conveyor.models import LoadCase, Scenario
from conveyor.report.excel import COMPARISON_SHEETS, SHEETS, SUMMARY_SHEET, build_workbook
from conveyor.report.tables.comparison_tables import comparison_contents
from conveyor.results.analysis import analyse_studies
from conveyor.results.comparisons import compare_compounds
from conveyor.starter.output_reference import KIND, output_page, page_words, table_cells
from conveyor.studies.states import StateRefusal

ROOT = Path(__file__).parent.parent.parent
SPECS = ROOT / "examples" / "specs"
CONVEYOR, COMPARISON = "Workbook of a conveyor", "Workbook of a comparison"
ADD = "in a workbook, but not in the page: a row in conveyor/_reference/workbook.md, then " + (
    "conveyor schema --workbook > docs/workbook.md"
)
GIVE = (
    "in workbook.md, but in no example: give it in `_of_a_rare_spec`, or remove it from conveyor/_reference/workbook.md"
)
STATES = {
    "steady",
    "braking",
    "design friction",
    "start, design friction",
    "least friction",
    "braking, least friction",
    "brakes on",
    "start",
    "drives off",
    "hopper filled",
    "run-out",
}


def _kind(kind):
    """Kind as the page has it: the currency is that of the spec's price."""
    return re.sub("^money [A-Z]{3}", "money", kind)


def _label(key, words):
    """Label of a column as the page has it: what a spec names stands in angle brackets."""
    if key in {"tension_states", "section_ends"} and words.partition(", FAILS")[0] in STATES:
        return "<state>"
    if key == "power_<n>" and words != "temperature":
        return "<compound>"
    if key == "landings" and words != "quantity":
        return "<loading point>"
    return words


def _read_words():
    """Of each workbook: sheets; by table its columns and figures with their kinds."""
    sheets, columns, names = {}, {}, {}
    book = sheet = table = ""
    for line in page_words("workbook").splitlines():
        if line.startswith("## Workbook of"):
            book = line.removeprefix("## ")
            sheets[book] = []
        elif line.startswith("## Sheet: "):
            sheet = line.removeprefix("## Sheet: ")
            sheets[book].append(sheet)
        elif line.startswith("### "):
            table = line.strip("# `")
            columns[book, sheet, table], names[book, table] = set(), set()
        elif line.startswith("| ") and table:
            cells = table_cells(line)
            if cells[0].startswith("`"):
                names[book, table].add((cells[0].strip("`"), *cells[1:]))
            elif KIND not in cells and len(cells) == 3:
                columns[book, sheet, table].add(tuple(cells[:2]))
    return sheets, columns, names


@pytest.fixture(scope="module")
def page():
    return _read_words()


def _of_a_rare_spec():
    """Lives and ratings of rolls, parts of drives, shafts, covers, CEMA's estimate, refusals, draws: in no spec."""
    line = conveyor.load(SPECS / "in_plant_us.yaml")
    idlers = line.idlers
    bearing = {
        "dynamic_rating": "22 kN",
        "distance": "0.3 m",
        "axle_diameter": "25 mm",
        "support_distance": "0.4 m",
    }
    roll = idlers.carry.roll.replace(bearing=bearing)
    carry = idlers.carry.replace(roll=roll, cema_class="D", flap_margin="15 %")
    cema = {"flexure_factor": 0.02, "idler_friction": "1.5 lbf"}
    line = line.replace(idlers=idlers.replace(carry=carry), calculation=line.calculation.replace(cema=cema))
    steel = line.belt.carcass.replace(kind="steel cord", strength="1600 N/mm", rating=None)
    pulley = {
        "name": "tail", "position": "tail", "diameter": "24 in", "shaft_diameter": "4 in", "mass": "1200 lb",
        "bearing_centres": "66 in", "hub_centres": "46 in", "shaft_steel": "C1018", "bearing_rating": "90000 lbf",
    }  # fmt: skip
    take_up = {"kind": "screw", "position": "tail", "travel": "2 ft"}
    parts = {
        "installed_power": "150 hp", "motors": 2, "motor_speed": "1770 rpm", "starts_per_hour": 1, "backstop": True,
        "brake_force": "2000 lbf", "brake_disc": "200 lb", "diameter_loss": "0.1 in", "torque_factor": 1.6,
        "pulley_diameter": "36 in", "coast_time": "1 min",
    }  # fmt: skip
    second = {"name": "second", "wrap_angle": "180 deg", "friction": 0.35, "installed_power": "150 hp"}
    route = line.route.replace(take_up=take_up, pulleys=(pulley,), head_transition={"length": "8 ft"})
    drawn = {"roll_drag": "10 %", "draws": 64}
    slow, warm = LoadCase(name="slow", speeds=("0.1 m/s",)), LoadCase(name="warm", temperatures=("95 degF",))
    fails = Scenario.from_data(
        {"name": "fails", "begins": "running", "events": [{"do": "power off"}], "duration": "2 s"}
    )
    splice = steel.replace(splice_strength="45 %")
    line = line.replace(
        cases=(slow, warm),
        route=route,
        uncertainty=drawn,
        belt=line.belt.replace(carcass=splice, wear={"lump": "4 in", "loading": "medium"}),
        drive=line.drive.replace(**parts, further_drives=(second,)),
        scenarios=(fails,),
    )
    asked = analyse_studies(line)
    refused = StateRefusal("full", 308.15, "bulk that does not fit")
    winch = conveyor.analyse(line.replace(route=route.replace(take_up={"kind": "winch"})))
    found = conveyor.analyse(line), replace(asked, states=replace(asked.states, refused=(refused,)))
    return [found, (winch, None)]


@pytest.fixture(scope="module")
def written(studied):
    """Contents of every example, and of the rare spec."""
    found = [studied(path.stem) for path in sorted(SPECS.glob("*.yaml"))]
    found += _of_a_rare_spec()
    made = [result.contents(asked) for result, asked in found]
    line = conveyor.load(SPECS / "in_plant_us.yaml")
    line = line.replace(operation=line.operation.replace(emission="0.4 kg/kWh", emission_source="x"))
    options = {
        "temperatures": ["-60 degC", "20 degC"],
        "rtol": 1e-3,
        "extra_costs": {"low-rolling-resistance-cover": 1},
    }
    compared = compare_compounds(line, ["standard-cover", "low-rolling-resistance-cover", "S100"], **options)
    return made, [comparison_contents(compared, "SI")]


def _tables(made):
    columns, names = {}, {}
    for part in (part for contents in made for part in contents.tables):
        key = re.sub(r"^power_\d+$", "power_<n>", part.key)
        shown = {(_label(key, column.label), _kind(column.kind)) for column in part.columns if column.sheet}
        columns.setdefault((part.sheet, key), set()).update(shown)
        figures = part.rows if part.links else ()
        names.setdefault(key, set()).update((each.key, each.label, _kind(each.kind)) for each in figures)
    return columns, names


def test_the_page_is_made_of_its_words():
    page = ROOT / "docs" / "workbook.md"
    assert page.read_text(encoding="utf-8") == output_page("workbook"), "conveyor schema --workbook > docs/workbook.md"


@pytest.mark.parametrize("book", [CONVEYOR, COMPARISON])
def test_sheets(page, book):
    sheets = list({CONVEYOR: (SUMMARY_SHEET, *SHEETS), COMPARISON: COMPARISON_SHEETS}[book])
    assert page[0][book] == sheets, (
        "## Sheet: <name> in conveyor/_reference/workbook.md, in the order of `excel.SHEETS`"
    )


def test_every_sheet_has_its_place_in_the_workbook(written):
    for made, known in zip(written, (SHEETS, COMPARISON_SHEETS), strict=True):
        new = {sheet for contents in made for sheet in contents.sheets} - set(known)
        assert new == set(), "give it its place and what fills it in `SHEETS` of conveyor/report/excel.py"


def _check_told(told, found, where):
    """Fail with what to do where the page and the workbooks differ."""
    assert set(found) - set(told) == set(), f"{where}: {ADD}"
    assert set(told) - set(found) == set(), f"{where}: {GIVE}"


@pytest.mark.parametrize("book", [CONVEYOR, COMPARISON])
def test_tables_columns_and_kinds(page, written, book):
    columns, _ = _tables(written[book == COMPARISON])
    told = {key[1:]: rows for key, rows in page[1].items() if key[0] == book}
    _check_told(told, columns, "tables")
    for key, rows in columns.items():
        _check_told(told[key], rows, key)


@pytest.mark.parametrize("book", [CONVEYOR, COMPARISON])
def test_names_of_figures(page, written, book):
    _, names = _tables(written[book == COMPARISON])
    told = {key[1]: rows for key, rows in page[2].items() if key[0] == book}
    for key, rows in names.items():
        _check_told(told[key], rows, key)


def test_the_workbooks_have_these_names_and_no_others(page, written):
    """Figures and tables; of the tables all but those that stand as text, and the covers' of nothing."""
    of = next(contents for contents in written[0] if "duty" in contents.by_key)
    ours = written[1][0]
    books = {CONVEYOR: build_workbook(of), COMPARISON: build_workbook(ours)}
    for book, made in books.items():
        figures = {name for key, rows in page[2].items() if key[0] == book for name, *_ in rows}
        tables = {f"table_{key[2]}" for key in page[1] if key[0] == book}
        tables |= {f"table_power_{n}" for n in range(1, 9)}
        assert set(made.defined_names) <= figures | tables
        contents = of if book == CONVEYOR else ours
        there = {f"table_{part.key}" for part in contents.tables if part.key != "remarks"}
        there |= {figure.key for part in contents.tables if part.links for figure in part.rows}
        assert set(made.defined_names) == there


def test_names_may_stand_in_a_formula(page):
    """Letters, digits, underscores; none that a spreadsheet reads as the address of a cell."""
    for rows in page[2].values():
        for name, *_ in rows:
            assert re.fullmatch(r"[a-z][a-z0-9_]*", name)
            assert not re.fullmatch(r"[a-z]{1,3}\d+|r|c|r\d*c\d*", name)
            assert len(name) <= 255
    # one name in one table; it may have two labels there, as at the start and in the motors' braking
    of_tables = [{name for name, *_ in rows} for key, rows in page[2].items() if key[0] == CONVEYOR]
    everywhere = [name for names in of_tables for name in names]
    assert len(everywhere) == len(set(everywhere))
