# ruff: noqa: E501 tables: one line a case
"""Malformed inputs made by rule: every field of a spec, cells, tables, compounds, options, numbers of a contact."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Callable, Iterator
from datetime import date
from functools import cache
from pathlib import Path
from typing import Any

from tests.robustness.arrange import (
    MASTER,
    SPEC,
    Arguments,
    Case,
    compound,
    given,
    laboratory,
    power,
    template,
    typed,
)

HOSTILE: dict[str, str] = {
    "subnormal": "5e-324 {unit}",
    "tiny": "1e-300 {unit}",
    "huge": "1e300 {unit}",
    "infinite": "1e999 {unit}",
    "not a number": "nan {unit}",
    "of no unit": "1 furlong",
    "a long word": "x" * 5_000,
    "a list": "[1, 2, 3]",
    "controls": '"\\e[31m\\x9b {unit}"',
    "nested": "{a: {b: {c: 1}}}",
}
"""Put in place of a field's value."""

FIELDS: dict[str, tuple[str, str]] = {
    "belt.width": ("width: 1000 mm", "mm"),
    "belt.speed": ("speed: 3 m/s", "m/s"),
    "cover.thickness": ("thickness: 6 mm", "mm"),
    "carry.spacing": ("spacing: 1.2 m", "m"),
    "carry.rolls": ("rolls: 3", ""),
    "section.length": ("length: 100 m", "m"),
    "section.lift": ("lift: 10 m", "m"),
    "material.flow": ("flow: 900 t/h", "t/h"),
    "drive.wrap_angle": ("wrap_angle: 200 deg", "deg"),
    "drive.friction": ("friction: 0.35", ""),
    "drive.efficiency": ("efficiency: 93 %", "%"),
    "ambient.temperature": ("temperature: 20 degC", "degC"),
}


def _replaced(old: str, new: str) -> Callable[[Path], Arguments]:
    assert old in SPEC, old
    key = old.partition(":")[0]
    return power(SPEC.replace(old, f"{key}: {new}", 1))


def specs() -> Iterator[Case]:
    """Every field with every hostile value, and some files as a whole."""
    for field, (old, unit) in FIELDS.items():
        for title, value in HOSTILE.items():
            if field == "ambient.temperature" and title in {"subnormal", "tiny"}:
                continue  # nearly 0 degC
            yield Case("spec", f"{field}: {title}", _replaced(old, value.replace("{unit}", unit)), "")
    for line in dict.fromkeys(text for text in SPEC.splitlines() if ":" in text):
        key = line.partition(":")[0].strip(" -{")
        yield Case(
            "spec",
            f"{line.strip()[:40]}: misspelt",
            power(SPEC.replace(line, line.replace(key, key + "x", 1), 1)),
            "",
        )
        if not line.startswith("name"):
            yield Case("spec", f"{line.strip()[:40]}: a bracket more", power(SPEC.replace(line, line + " ]", 1)), "")
    for cut in range(20, len(SPEC) - 60, max(1, len(SPEC) // 12)):
        yield Case("spec", f"cut after {cut} letters", power(SPEC[:cut]), "")
    whole = {
        "8,000 unknown keys": SPEC + "".join(f"k{i}: 1\n" for i in range(8_000)),
        "a key of 900 letters": SPEC + "k" * 900 + ": 1\n",
        "a compound of 100,000 letters": SPEC.replace("standard-cover", "z" * 100_000, 1),
        "a name of 100,000 letters": SPEC.replace("name: Small", "name: " + "n" * 100_000),
        "a number of 100,000 digits": SPEC.replace("1000 mm", "9" * 100_000 + " mm"),
        "many brackets": "[" * 5_000,
        "many quotes": '"' * 5_000,
        "many colons": ": " * 5_000,
        "many anchors": "".join(f"k{i}: &a{i} 1\n" for i in range(500)) + "x: *none\n",
        "carriage returns": SPEC.replace("\n", "\r") + "\rx: 1",
        "a tag on everything": SPEC.replace(": ", ": !!binary "),
        "a sixth drive": SPEC.replace("drive: {", "drive: {share: 6, "),
    }
    for title, text in whole.items():
        yield Case("spec", title, power(text), "")


def jsons() -> Iterator[Case]:
    """JSON that Python reads and JSON does not know, and types that no field has."""
    from tests.robustness.arrange import as_json

    for title, value in {
        "NaN": "NaN", "Infinity": "Infinity", "minus Infinity": "-Infinity", "1e400": "1e400", "null": "null",
        "a lone surrogate": r'"\ud800"', "an empty text": '""', "a boolean": "true", "5e-324": "5e-324",
        "a key of 100,000 letters": '{"' + "k" * 100_000 + '": 1}',
    }.items():  # fmt: skip
        for old in ('"1000 mm"', '"900 t/h"', "0.35"):
            yield Case("JSON", f"{old}: {title}", as_json(lambda text, o=old, v=value: text.replace(o, v, 1)), "")
    yield Case("JSON", "names of lone surrogates", as_json(lambda text: text.replace('"Small"', r'"\ud83d"')), "")


@cache
def _parts() -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(template())) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def _zipped(parts: dict[str, bytes]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in parts.items():
            archive.writestr(name, content)
    return stream.getvalue()


def _book(change: Callable[[dict[str, bytes]], dict[str, bytes]]) -> Callable[[Path], Arguments]:
    def arrange(folder: Path) -> Arguments:
        (folder / "input.xlsx").write_bytes(_zipped(change(dict(_parts()))))
        return ("power", "input.xlsx")

    return arrange


def workbooks() -> Iterator[Case]:
    """Parts that swell, lack, contradict; cells of every wrong kind."""
    sheet, end = "xl/worksheets/sheet2.xml", b"</sheetData>"

    def inside(old: bytes, new: bytes) -> Callable[[Path], Arguments]:
        return _book(lambda parts: parts | {sheet: parts[sheet].replace(old, new, 1)})

    swelling = {
        "merged": end + b'<mergeCells><mergeCell ref="B40:XFD1048576"/></mergeCells>',
        "merged columns": end + b'<mergeCells><mergeCell ref="A:XFD"/></mergeCells>',
        "merged beyond": end + b'<mergeCells><mergeCell ref="A1:ZZZZ99999999"/></mergeCells>',
        "a cell twice": b'<row r="60"><c r="B60"><v>1</v></c><c r="B60"><v>2</v></c></row>' + end,
        "empty cells": b'<row r="60">' + b"<c/>" * 1_500_000 + b"</row>" + end,
        "empty rows": b"<row/>" * 1_000_000 + end,
        "a far row": b'<row r="99999999999"><c/></row>' + end,
        "a far cell": b'<row r="60"><c r="XFE60"/></row>' + end,
        "a negative row": b'<row r="-1"><c r="A-1"/></row>' + end,
        "nested": b"<a>" * 100_000 + b"</a>" * 100_000 + end,
        "a long tag": b"<row " + b" ".join(b'a%d="1"' % i for i in range(100_000)) + b"/>" + end,
        "a shared formula of all cells": b'<row r="60"><c r="B60"><f t="shared" ref="A1:XFD1048576" si="0">A1</f></c></row>'
        + end,
        "a style that is none": b'<row r="60"><c r="B60" s="99999"><v>1</v></c></row>' + end,
        "a text that is none": b'<row r="60"><c r="B60" t="s"><v>99999</v></c></row>' + end,
        "a number that is none": b'<row r="60"><c r="B60"><v>x</v></c></row>' + end,
        "a number too large": b'<row r="60"><c r="B60"><v>1e999</v></c></row>' + end,
    }
    for title, new in swelling.items():
        yield Case("workbook", title, inside(end, new), "")
    for part in (
        "xl/workbook.xml",
        "[Content_Types].xml",
        "xl/styles.xml",
        sheet,
        "xl/_rels/workbook.xml.rels",
    ):
        yield Case("workbook", f"{part} empty", _book(lambda parts, p=part: parts | {p: b""}), "")
        yield Case(
            "workbook",
            f"{part} cut off",
            _book(lambda parts, p=part: parts | {p: parts[p][: len(parts[p]) // 2]}),
            "",
        )
        if part != "xl/styles.xml":
            yield Case(
                "workbook",
                f"{part} missing",
                _book(lambda parts, p=part: {k: v for k, v in parts.items() if k != p}),
                "",
            )
        yield Case(
            "workbook",
            f"{part} with entities",
            _book(lambda parts, p=part: parts | {p: b'<!DOCTYPE a [<!ENTITY b "c">]>' + parts[p]}),
            "",
        )
    from tests.robustness.arrange import book

    for title, value in {
        "a date": date(2026, 1, 1), "an error": "#DIV/0!", "a formula": "=1+1", "yes": True,
        "a long text": "x" * 30_000, "tiny": 1e-300, "subnormal": 5e-324, "huge": 1e300, "a comma": "1,2",
    }.items():  # fmt: skip
        yield Case("workbook", f"belt.width: {title}", book(typed(value)), "")


def compounds() -> Iterator[Case]:
    """Fields of a compound file."""
    text = (Path(__file__).parents[2] / "materials" / "standard-cover.yaml").read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if ":" in line and not line.lstrip().startswith("#")]
    for line in lines[:14]:
        key = line.partition(":")[0]
        for title, value in {
            "missing": None, "a list": "[[]]", "a mapping": "{a: 1}", "a control": '"\\a\\e[0m"', "a long word": "x" * 5_000,
        }.items():  # fmt: skip
            if title in {"a control", "a long word"} and key.strip() in _TEXTS:
                continue
            spoilt = text.replace(line + "\n", "" if value is None else f"{key}: {value}\n", 1)
            if value is None and key.strip() in _OPTIONAL:
                continue
            yield Case("compound", f"{line.strip()[:40]}: {title}", compound(spoilt), "")
    times = [line for line in lines if "time:" in line][:1]
    for line in times:
        for value in ("1e300 s", "5e-324 s", "-1 s", "0 s", "1e26 s", "nan s", "1 m"):
            start, _, rest = line.partition("time:")
            spoilt = text.replace(line, f"{start}time: {value}{'}' if '}' in rest else ''}", 1)
            yield Case("compound", f"a relaxation time of {value}", compound(spoilt), "")


_TEXTS = {"name", "description", "origin", "licence", "note", "strain", "url", "citation"}
_OPTIONAL = (_TEXTS | {"density", "- {modulus"}) - {"name", "origin"}


def tables() -> Iterator[Case]:
    """Files of a laboratory."""
    at = ("--at", "20 degC")
    rows = MASTER.splitlines()
    texts: dict[str, str | bytes] = {
        "a quoted field of 200,000 letters": 'f,"' + "x" * 200_000 + '",E\n1,2,3\n',
        "a line of a megabyte": "1," * 500_000 + "\n",
        "one column": "frequency_Hz\n" + "\n".join(str(k) for k in range(20)),
        "no rows": rows[0] + "\n",
        "no header": "\n".join(rows[1:]),
        "one row": "\n".join(rows[:2]),
        "zeros": rows[0] + "\n" + "0,0,0\n" * 10,
        "negative": rows[0] + "\n" + "\n".join(f"{10.0**k},-5,-1" for k in range(6)),
        "not numbers": rows[0] + "\n" + "nan,nan,nan\n" * 8,
        "infinite": rows[0] + "\n" + "inf,inf,inf\n" * 8,
        "subnormal": rows[0] + "\n" + "\n".join(f"{10.0**k},5e-324,5e-324" for k in range(6)),
        "huge": rows[0] + "\n" + "\n".join(f"{10.0**k},1e308,1e308" for k in range(6)),
        "nulls": b"\0" * 5_000,
        "an image": b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 8,
        "quotes": '"' * 9_999,
        "separators": ";" * 9_999 + "\n" + "," * 9_999,
        "words": "alpha beta gamma\n" * 50,
        "empty": "",
        "blank lines": "\n" * 5_000,
        "half of the rows swapped": rows[0] + "\n" + "\n".join(f"{5 + k},{10.0**k},x" for k in range(6)),
    }
    for title, text in texts.items():
        yield Case("table", title, laboratory(text, *at), "")
        yield Case("table", f"{title}, as shift factors", _two(text, "--shift"), "")
        yield Case("table", f"{title}, as strain sweeps", _two(text, "--strain"), "")


def _two(text: str | bytes, option: str) -> Callable[[Path], Arguments]:
    def arrange(folder: Path) -> Arguments:
        (folder / "other.csv").write_bytes(text.encode() if isinstance(text, str) else text)
        return (*laboratory(MASTER, "--at", "20 degC")(folder), option, "other.csv")

    return arrange


CONTACT = {
    "radius": "0.1",
    "pressure": "0.01",
    "weight": "0.5",
    "time": "1",
    "thickness": "1",
    "poisson": "0.5",
    "rtol": "1e-6",
}


def contacts() -> Iterator[Case]:
    """Numbers of a contact."""
    for name in CONTACT:
        for value in ("5e-324", "1e-300", "1e300", "1e308", "-1", "nan", "1e999", "x", "", "1,5", "--"):
            if (name, value) in _ANSWERED:
                continue
            options = CONTACT | {name: value}
            yield Case(
                "contact",
                f"{name} {value}",
                given("contact", *(f"--{key}={text}" for key, text in options.items())),
                "",
            )
    for value in ("5e-324", "1e-300", "1e300", "1e308", "-1", "0", "nan"):
        options = {key: text for key, text in CONTACT.items() if key != "pressure"} | {"penetration": value}
        yield Case(
            "contact",
            f"penetration {value}",
            given("contact", *(f"--{k}={v}" for k, v in options.items())),
            "",
        )


_ANSWERED = {
    ("weight", "5e-324"),
    ("weight", "1e-300"),
    ("thickness", "1e999"),
    ("poisson", "5e-324"),
    ("poisson", "1e-300"),
}
"""Small numbers that mean none, and infinity where it is allowed."""


def commands() -> Iterator[Case]:
    """Command lines."""
    fit = ("fit", "data.csv", "--at", "20 degC")
    lines: list[tuple[str, ...]] = [
        ("power",), ("power", "spec.yaml", "spec.yaml"), ("power", "\x1b[31m.yaml"), ("power", "x" * 5_000 + ".yaml"),
        ("power", "spec.yaml", "-o"), ("power", "spec.yaml", "--units", "x" * 5_000),
        ("power", "spec.yaml", "-o", "x" * 300 + ".xlsx"), ("power", "spec.yaml", "--shelf", "spec.yaml"),
        ("power", "spec.yaml", "--shelf", "nowhere"), ("power", "spec.yaml", "-o", "spec.xlsx/r.xlsx"),
        ("compare", "spec.yaml"), ("compare", "spec.yaml", "-c", ""), ("compare", "spec.yaml", "-c", "x" * 9_000), ("compare", "spec.yaml", "-c", "\x1b"),
        *(("compare", "spec.yaml", "-c", "s100", "--speed", v) for v in ("-5", "0", "nan", "1:2", "5:1:1", "1:2:0", "1e300", "5e-324", "a,b", "1:1e9:1e-9", "30")),
        *(("compare", "spec.yaml", "-c", "s100", "--temperature", v) for v in ("nan", "-400", "1e300", "x", "1:2:-1", "")),
        *(("compare", "spec.yaml", "-c", "s100", "--extra-cost", v) for v in ("s100", "s100=", "=5", "s100=nan", "s100=1e999", "other=5")),
        *(("compare", "spec.yaml", "-c", "s100", option, "x") for option in ("--cover", "--base", "--units", "-o", "--plot-kind")),
        *((*fit, "--terms-per-decade", v) for v in ("1e9", "-1", "0", "nan", "1e-9", "1e300", "x")),
        *((*fit, "--poisson", v) for v in ("-1", "1", "nan", "5")), *((*fit, "--by", v) for v in ("x", "")),
        *(("fit", "data.csv", "--at", v) for v in ("x", "-400 degC", "1e300 degC", "20", "nan degC", "")),
        *((*fit, "--equilibrium", v) for v in ("1e300 MPa", "-1 MPa", "5e-324 Pa", "x", "1 mm")), (*fit, "--modulus-unit", "x"), (*fit, "--sheet", "x"),
        *(("shelf", "s100", "--at", v) for v in ("x", "-400 degC", "1e300 degC", "nan K")),
        *(("shelf", "s100", "--frequency", v) for v in ("x", "-1 Hz", "1e300 Hz", "5e-324 Hz", "10 rad/s")),
        ("shelf", "nothing"), ("shelf", "x" * 9_000), ("shelf", "\x1b]0;"), ("new", "x.txt"), ("new", "nowhere/x.yaml"),
        ("template", "x.txt"), ("template", "x.xlsx", "--from", "nothing.yaml"), ("validate", "x"), ("schema", "--x"), ("", ""),
    ]  # fmt: skip
    for line in lines:

        def arrange(folder: Path, line: tuple[str, ...] = line) -> Arguments:
            (folder / "data.csv").write_text(MASTER, encoding="utf-8")
            return given(*line)(folder)

        yield Case("command", " ".join(line)[:60], arrange, "")


def every() -> list[Case]:
    """All of them, each under a name of its own."""
    made: dict[str, Case] = {}
    for group in (specs, jsons, workbooks, compounds, tables, contacts, commands):
        for case in group():
            name = json.dumps(f"{case.group} {case.title}")
            made[name if name not in made else f"{name} {len(made)}"] = case
    return list(made.values())


def name(case: Any) -> str:
    """Name of a case that a terminal shows."""
    return json.dumps(f"{case.group}: {case.title}")[1:-1]
