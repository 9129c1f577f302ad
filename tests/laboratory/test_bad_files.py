"""Bad files: one line each, naming file, row, column and remedy."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from conveyor.errors import InputError
from conveyor.laboratory import read_dma

BAD = Path(__file__).parent / "files" / "bad"

MODULUS = 'modulus_unit="MPa" (--modulus-unit MPa)'
HEADER = "'frequency_Hz,E'_MPa,E''_MPa'"

# file, row, column, what is wrong, remedy: rows and columns counted by hand in the files
CASES = [
    ("empty.csv", 1, "1", "the file is empty", "export the table again"),
    ("pdf_report.csv", 1, "1", "a PDF report", "export the table as CSV"),
    ("old_workbook.xls", 1, "1", "an old .xls workbook", "save it as .xlsx or CSV"),
    ("damaged.xlsx", 1, "A", "damaged or cut short", "save or copy it again"),
    ("utf16_without_mark.txt", 1, "1", "UTF-16 without its mark", "save it as UTF-8"),
    ("html_table.xls", 1, "1", "this is HTML", "export it as CSV"),
    ("header_only.csv", 2, "1", "no row of numbers below it", "one row for each measurement"),
    ("no_header.csv", 1, "1", "numbers without a header", HEADER),
    ("unknown_names.csv", 1, "1", "fewer than two known quantities", "rename its columns"),
    ("prony_terms.csv", 2, "1", "fewer than two known quantities", "rename its columns"),
    ("no_frequency_unit.csv", 1, "1", "Hz or rad/s?", 'frequency_unit="Hz" (--frequency-unit Hz)'),
    ("no_modulus_unit.csv", 1, "2", "storage has no unit", MODULUS),
    ("no_temperature_unit.csv", 1, "1", "temperature has no unit", "(--temperature-unit degC)"),
    ("no_strain_unit.csv", 1, "1", "strain has no unit", 'strain_unit="%" (--strain-unit %)'),
    ("no_time_unit.csv", 1, "1", "time has no unit", "write it in the header; allowed: s, ms, min, h"),
    ("no_phase_unit.csv", 1, "3", "phase has no unit", "write it in the header; allowed: deg, rad"),
    ("one_per_second.csv", 1, "1", "'1/s' may be Hz or rad/s", "(--frequency-unit Hz)"),
    ("omega_in_hertz.csv", 1, "1", "an angular frequency in Hz", "(--frequency-unit rad/s)"),
    ("millipascal.csv", 1, "2", "reads millipascal", MODULUS),
    ("unknown_unit.csv", 1, "2", "'tsi' of storage is not known", MODULUS),
    ("header_against_unit_row.csv", 1, "2", "the header says Pa, the unit row MPa", MODULUS),
    ("pascal_means_megapascal.txt", 2, "4", "storage = 12.40 in Pa", MODULUS),
    ("gigapascal_too_much.csv", 2, "2", "storage = 5.6e3 in GPa", "(--modulus-unit Pa)"),
    ("two_moduli_units.csv", 3, "4", "E''/E' = 1.1e-07", "correct them"),
    ("swapped_columns.csv", 2, "2", "columns of E' and E'' swapped", "rename the columns"),
    ("negative_loss.csv", 3, "3", "loss = -0.01 must be > 0", "repair or delete the row"),
    ("zero_storage.csv", 3, "2", "storage = 0 must be > 0", "repair or delete the row"),
    ("negative_frequency.csv", 2, "1", "frequency = -1 must be > 0", "name it 'log10 f'"),
    ("not_a_number.csv", 3, "2", "'n/a' is not a finite number", "delete the row"),
    ("infinite.csv", 3, "3", "'1e999' is too large", "repair or delete the row"),
    ("overload.csv", 3, "3", "'OVL' is not a finite number", "delete the row"),
    ("unit_in_cell.csv", 3, "1", "'10 Hz' holds a unit", "the unit in the header"),
    ("date_from_excel.csv", 3, "2", "'06.08.2024' looks like a date", "restore the number"),
    ("empty_cell.csv", 3, "2", "the cell is empty", "complete or delete the row"),
    ("cut_short.csv", 4, "3", "a line cut short", "complete or delete the row"),
    ("footer.csv", 5, "1", "'end of file' is not a number", "put # in front"),
    ("extra_cell.csv", 3, "4", "4 cells, the header names 3", "remove the extra cell"),
    (
        "decimal_comma_in_comma_file.csv",
        2,
        "4",
        "decimal commas in a table separated by commas",
        "semicolons",
    ),
    ("decimal_comma_or_thousands.csv", 2, "2", "'5,600': a decimal comma or a thousands", "decimal points"),
    ("mixed_decimal_marks.csv", 3, "2", "'6,8': a comma here and decimal points", "decimal points"),
    ("thousands_separator.csv", 2, "2", "'5,600.0' has a thousands separator", "without it"),
    ("two_storage_columns.csv", 1, "4", "a second column for storage", "keep one"),
    ("e_and_g.csv", 1, "3", "a shear modulus beside a tensile one", "rename the rest"),
    ("e_or_g.csv", 2, "2", "E or G?", 'give letter "E" or "G" (--moduli E'),
    ("tan_delta_contradicts.csv", 3, "4", "tan delta is 0.21, but E''/E' = 0.11", "correct them"),
    ("hertz_contradicts.csv", 3, "2", "1.59155 Hz by this column, 10 Hz", "(--frequency-unit)"),
    ("below_absolute_zero.csv", 2, "1", "below absolute zero", "(--temperature-unit degC)"),
    ("kelvin_as_celsius.csv", 2, "1", "kelvin and degC mixed up", "(--temperature-unit K)"),
    ("celsius_as_kelvin.csv", 2, "1", "kelvin and degC mixed up", "(--temperature-unit degC)"),
    ("percent_as_fraction.csv", 5, "1", "more than 100 %", 'strain_unit="%" (--strain-unit %)'),
    ("no_loss.csv", 1, "3", "make no measurement", "E'' or tan delta"),
    (
        "kind_open.csv",
        1,
        "1",
        "the strain varies together with frequency",
        "(--kind), one of master curve, isotherms",
    ),
    ("isotherms_without_temperature.csv", 1, "1", "the frequencies begin anew", "(--temperature)"),
    ("second_table.csv", 5, "2", "a second table begins here", "in a file of its own"),
    ("storage_falls.csv", 4, "2", "E' falls as the frequency rises", "add a column temperature_degC"),
    ("relaxation_rises.csv", 4, "2", "E(t) rises with time", "correct the header"),
    ("shift_inverse.csv", 4, "2", "a_T rises with temperature", "f_reduced = f a_T"),
    ("shift_log_unnamed.csv", 3, "2", "a_T = 0 must be > 0", "name it 'log10 a_T'"),
    ("shift_twice.csv", 4, "1", "a second shift factor at this temperature", "delete one"),
    ("names_units_width.csv", 2, "4", "the unit row has 4 cells", "one name and one unit"),
    ("two_tables.xlsx", 1, "A", "2 sheets hold a table: '20C', '40C'", 'sheet="20C" (--sheet)'),
    ("no_table.xlsx", 1, "A", "no table on any sheet ('Notes')", HEADER),
    ("formula_without_value.xlsx", 3, "C", "a formula without a stored value", "complete or delete the row"),
    ("date_cell.xlsx", 2, "B", "Excel made a date of it (date 2024-06-05", "format the column as Number"),
    ("percent_format.xlsx", 2, "A", "shown as a percentage", "set the cell format to Number"),
]


def test_every_bad_file_has_its_case() -> None:
    assert sorted(case[0] for case in CASES) == sorted(file.name for file in BAD.iterdir())


@pytest.mark.parametrize(("name", "row", "column", "what", "remedy"), CASES, ids=[case[0] for case in CASES])
def test_refusal_names_file_row_column_and_remedy(name: str, row: int, column: str, what: str, remedy: str) -> None:
    place = rf"^{re.escape(name)}(\[\w+\])?:{row}: column {column}( \".*?\")?: "
    with pytest.raises(InputError, match=place) as refused:
        read_dma(BAD / name)
    message = str(refused.value)
    # further findings of the same file stand in lines of their own
    assert all(line.startswith((name, "these at once: --")) for line in message.splitlines())
    assert what in message
    assert remedy in message.split(what, 1)[1]


# what the message asks for, once given, reads the same file
ANSWERS = [
    ("no_frequency_unit.csv", {"frequency_unit": "rad/s"}),
    ("no_modulus_unit.csv", {"modulus_unit": "MPa"}),
    ("no_temperature_unit.csv", {"temperature_unit": "degC"}),
    ("no_strain_unit.csv", {"strain_unit": "%"}),
    ("one_per_second.csv", {"frequency_unit": "Hz"}),
    ("omega_in_hertz.csv", {"frequency_unit": "rad/s"}),
    ("millipascal.csv", {"modulus_unit": "MPa"}),
    ("unknown_unit.csv", {"modulus_unit": "MPa"}),
    ("header_against_unit_row.csv", {"modulus_unit": "MPa"}),
    ("pascal_means_megapascal.txt", {"modulus_unit": "MPa"}),
    ("below_absolute_zero.csv", {"temperature_unit": "degC"}),
    ("kelvin_as_celsius.csv", {"temperature_unit": "K"}),
    ("celsius_as_kelvin.csv", {"temperature_unit": "degC"}),
    ("percent_as_fraction.csv", {"strain_unit": "%"}),
    ("kind_open.csv", {"kind": "strain sweep"}),
    ("isotherms_without_temperature.csv", {"temperature": 293.15}),
    ("two_tables.xlsx", {"sheet": "40C"}),
]


@pytest.mark.parametrize(("name", "answer"), ANSWERS, ids=[case[0] for case in ANSWERS])
def test_answer_to_the_question_reads_the_file(name: str, answer: dict[str, object]) -> None:
    data = read_dma(BAD / name, **answer)  # type: ignore[arg-type]
    assert data.row_numbers.size >= 2
    if "modulus_unit" in answer:
        assert any("MPa as given" in sentence for sentence in data.understood)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"poisson_ratio": 0.6}, r"poisson_ratio = 0\.6 \(--poisson\) must be 0 to 0\.5"),
        ({"poisson_ratio": float("nan")}, r"poisson_ratio = nan \(--poisson\)"),
        (
            {"temperature": 20.0},
            r"temperature = 20 K \(--temperature\) must be 113\.15 to 523\.15 K; 20 degC",
        ),
        ({"kind": "sweep"}, r'kind = "sweep" \(--kind\) is not known; allowed: master curve, isotherms'),
        ({"modulus_unit": "mPa"}, r'modulus_unit = "mPa" \(--modulus-unit\) is not known; allowed: Pa, kPa'),
        (
            {"frequency_unit": "1/s"},
            r'frequency_unit = "1/s" \(--frequency-unit\) is not known; allowed: Hz, rad/s',
        ),
        ({"temperature_unit": "R"}, r'temperature_unit = "R" \(--temperature-unit\).* degC, degF, K'),
        ({"strain_unit": "mm"}, r'strain_unit = "mm" \(--strain-unit\) is not known; allowed: -, %'),
        ({"sheet": "Data"}, r"own_layout\.csv:1: column 1: a text file has no sheet 'Data'; leave out sheet"),
        ({"kind": "isotherms"}, r"own_layout\.csv:4: .*a isotherms needs temperature .*give temperature"),
        (
            {"kind": "relaxation"},
            r"own_layout\.csv:4: .*needs time and modulus \(found: frequency, loss, storage",
        ),
    ],
)
def test_options_are_checked(options: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        read_dma(BAD.parent / "good" / "own_layout.csv", **options)  # type: ignore[arg-type]


def test_temperature_given_twice() -> None:
    with pytest.raises(InputError, match=r"isotherms_set\.csv:1: column 4 \"T\": the file has its temperatures"):
        read_dma(BAD.parent / "good" / "isotherms_set.csv", temperature=293.15)


def test_sheet_that_is_not_there() -> None:
    with pytest.raises(InputError, match=r"no sheet '60C'; sheet \(--sheet\) must be one of '20C', '40C'"):
        read_dma(BAD / "two_tables.xlsx", sheet="60C")


def test_no_such_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"pad\.csv: no such file"):
        read_dma(tmp_path / "pad.csv")
    with pytest.raises(InputError, match="is a folder; give a file in it"):
        read_dma(tmp_path)
