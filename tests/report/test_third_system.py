"""A system of units is one row: with a third one every table, sentence, check and page is written in it."""

from __future__ import annotations

import html
import re
import subprocess
import sys
from pathlib import Path

import pytest

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
ROW = """UnitSystem(kinds={
    "length": Shown("km", ",.4f"), "spacing": Shown("cm", ".1f"), "thickness": Shown("cm", ",.3f"),
    "size": Shown("cm", ",.2f"), "area": Shown("cm^2", ",.0f"), "speed": Shown("km/h", ".2f"),
    "acceleration": Shown("ft/s^2", ".3f"), "mass": Shown("t", ",.3f"), "line mass": Shown("t/m", ".5f"),
    "density": Shown("t/m^3", ".3f"), "force": Shown("MN", ",.5f"), "roll force": Shown("MN", ",.7f"),
    "line force": Shown("kN/m", ",.4f"), "strength": Shown("kN/m", ",.1f"), "belt strength": Shown("kN/m", ",.1f"),
    "pressure": Shown("bar", ",.3f"), "torque": Shown("MN*m", ",.5f"), "inertia": Shown("lb*ft^2", ".1f"),
    "temperature": Shown("K", ".2f"), "mass flow": Shown("kg/s", ",.2f"), "power": Shown("MW", ",.4f"),
    "energy": Shown("kWh", ",.0f"), "heat": Shown("kWh", ".3f"),
}),"""
PROGRAM = """
import sys
from importlib.machinery import SourceFileLoader

read = SourceFileLoader.get_code

def with_row(loader, name):
    if name != "conveyor.units.unit_systems":
        return read(loader, name)
    source = loader.get_source(name)
    before, first, after = source.partition('"SI": UnitSystem(),')
    return compile(before + first + '"KM": ' + sys.argv.pop(1) + after, loader.path, "exec")

SourceFileLoader.get_code = with_row
from conveyor.cli import main
main()
"""
NOT_KM = "m|mm|m/s|m/s²|kN|N|kW|MPa|N/mm|N/m|kg|kg/m|kg/m³|t/h|°C|degC|N m|m²|kg m²|MWh|MJ|kJ"
US = "ft|in|lbf|psi|hp|fpm|lb|lb/ft|lb/ft³|lbf/in|°F|degF|stph|PIW|mph|short ton|lbf ft"
AS_ENTERED = {"inputs", "inputs_given", "inputs_default", "compounds", "provenance", "remarks"}
"""Tables of what was entered or is cited."""


def _figures_in(text: str, units: str) -> list[str]:
    """Figures with one of the units, and headers with it."""
    return re.findall(rf"(?:(?<=\d) [ ]*|\[)(?:{units})(?![\w²³/°])(?! [mk]\b).{{0,20}}", text)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    """What the terminal shows, and the folder of page and tables."""
    folder = tmp_path_factory.mktemp("km")
    (folder / "tables").mkdir()
    asked = ["power", str(SPECS / "overland.yaml"), "--units", "km", "-o", str(folder / "page.html")]
    command = [sys.executable, "-c", PROGRAM, ROW, *asked, "--tables", str(folder / "tables")]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout, folder


def test_a_third_system_writes_tables_and_checks(written: tuple[str, Path]) -> None:
    tables = {path.stem: path.read_text(encoding="utf-8-sig") for path in (written[1] / "tables").glob("*.csv")}
    assert "motor power [MW]" in tables["results"]
    assert re.search(r"0\.\d+ MN", tables["checks"])
    for name, text in tables.items():
        if name not in AS_ENTERED:
            assert _figures_in(text, f"{NOT_KM}|{US}") == [], name


def test_a_third_system_writes_the_terminal(written: tuple[str, Path]) -> None:
    assert re.search(r"motor power +1\.\d+ MW", written[0])
    shown = written[0].partition("\npage: ")[0]
    assert _figures_in(shown, f"{NOT_KM}|{US}") == []


def test_no_us_unit_is_on_the_page_of_a_third_system(written: tuple[str, Path]) -> None:
    page = (written[1] / "page.html").read_text(encoding="utf-8")
    words = html.unescape(re.sub(r"<[^>]*>", " ", re.sub(r"<(style|script).*?</\1>", "", page, flags=re.DOTALL)))
    assert " MW" in words
    assert _figures_in(words, US) == []
