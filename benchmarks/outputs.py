"""Every output of every example spec, to be compared before and after a change.

    python benchmarks/outputs.py FOLDER               # writes them, with the package of this checkout
    python benchmarks/outputs.py --compare BEFORE AFTER      # files that only one has are named, too

Of each spec, in SI and US units: `power` and `compare` as JSON, tables, workbook, page and on the terminal. Numbers
are compared to 1e-12 relative, text exactly; of a workbook its cells with their formats, and its names.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import openpyxl

ROOT = Path(__file__).resolve().parents[1]
SPECS = ROOT / "examples" / "specs"
RTOL = 1e-12
MOST = 20
"""Differences of one file that are printed."""
COMPARED = ("-c", "standard-cover", "-c", "S100", "--temperature", "-10:30:20", "--extra-cost", "S100=1000")


def _run(*arguments: str) -> str:
    ran = subprocess.run(
        [sys.executable, "-m", "conveyor.cli", *arguments],
        capture_output=True,
        text=True,
        check=False,
        cwd=ROOT,
        env=os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "COLUMNS": "120"},
    )
    return ran.stdout if ran.returncode == 0 else f"exit code {ran.returncode}\n{ran.stderr}"


def write(folder: Path, only: str) -> None:
    """Write every output into a folder: one a spec and command."""
    for spec in sorted(SPECS.glob(only)):
        for command, options in (("power", ()), ("compare", COMPARED)):
            where = folder / f"{spec.stem}-{command}"
            where.mkdir(parents=True, exist_ok=True)
            asked = (command, str(spec.relative_to(ROOT)), *options)
            for system in ("si", "us"):
                files = ("-o", str(where / f"{system}.xlsx"), "-o", str(where / f"{system}.html"))
                tables = ("--tables", str(where / system), "--units", system)
                if system == "si":
                    said = _run(*asked, *files, *tables, "--json")
                    (where / "result.json").write_text(said, encoding="utf-8")
                else:
                    said = _run(*asked, *files, *tables).replace(f"{folder}{os.sep}", "")
                    (where / "terminal.txt").write_text(said, encoding="utf-8")
            print(where, flush=True)


def _same(one: Any, other: Any) -> bool:
    if type(one) in {int, float} and type(other) in {int, float}:
        return math.isclose(one, other, rel_tol=RTOL) or (math.isnan(one) and math.isnan(other))
    return type(one) is type(other) and one == other


def _read(text: str) -> Any:
    try:
        return float(text)
    except ValueError:
        return text


def _leaves(path: Path) -> Iterator[tuple[str, Any]]:
    """What a file holds, each with its place."""
    if path.suffix == ".xlsx":
        book = openpyxl.load_workbook(path)
        yield from ((f"name {name}", found.attr_text) for name, found in book.defined_names.items())
        for sheet in book:
            yield f"{sheet.title} set up", (sheet.freeze_panes, sheet.auto_filter.ref, len(sheet._charts))  # noqa: SLF001
            yield from ((f"{sheet.title} {x}", d.width) for x, d in sheet.column_dimensions.items())
            for cell in (cell for row in sheet.iter_rows() for cell in row if cell.value is not None):
                place = f"{sheet.title}!{cell.coordinate}"
                yield place, cell.value
                look = cell.number_format, cell.font.b, cell.fill.fgColor.rgb, cell.alignment.horizontal
                yield f"{place} look", look
        return
    text = path.read_text(encoding="utf-8-sig")
    if path.suffix == ".json" and text.startswith("{"):
        yield from _inside("", json.loads(text))
    elif path.suffix == ".csv":
        for i, row in enumerate(csv.reader(text.splitlines())):
            yield from ((f"row {i} column {j}", _read(cell)) for j, cell in enumerate(row))
    else:
        yield from ((f"line {i}", line) for i, line in enumerate(text.splitlines(), start=1))


def _inside(place: str, value: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict):
        yield f"{place} keys", sorted(value)
        for key, item in value.items():
            yield from _inside(f"{place}.{key}", item)
    elif isinstance(value, list):
        yield f"{place} length", len(value)
        for i, item in enumerate(value):
            yield from _inside(f"{place}[{i}]", item)
    else:
        yield place, value


def compare(before: Path, after: Path) -> int:
    """Print what differs; how many files do."""
    names = sorted({path.relative_to(top) for top in (before, after) for path in top.rglob("*") if path.is_file()})
    wrong = 0
    for name in names:
        if not ((before / name).exists() and (after / name).exists()):
            found = [f"only in {before if (before / name).exists() else after}"]
        else:
            one, other = dict(_leaves(before / name)), dict(_leaves(after / name))
            found = [
                f"{place}: {one.get(place)!r} -> {other.get(place)!r}"
                for place in dict.fromkeys((*one, *other))
                if not (place in one and place in other and _same(one[place], other[place]))
            ]
        wrong += bool(found)
        for line in found[:MOST]:
            print(f"{name}: {line[:400]}")
        if len(found) > MOST:
            print(f"{name}: {len(found)} differences in all")
    print(f"{wrong} of {len(names)} files differ")
    return wrong


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--compare", action="store_true")
    parser.add_argument("--only", default="*.yaml", help="pattern of the specs")
    parser.add_argument("folders", nargs="+", type=Path)
    given = parser.parse_args()
    if given.compare:
        sys.exit(bool(compare(*given.folders)))
    write(given.folders[0].resolve(), given.only)
