"""What people and disks do to the way in: one case each, with the exit code and the heart of the message."""

from __future__ import annotations

import errno
import io
import json
import os
import zipfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

SPEC = """\
name: Small
belt:
  width: 1000 mm
  speed: 3 m/s
  top_cover: {thickness: 6 mm, compound: standard-cover}
  bottom_cover: {thickness: 4 mm, compound: standard-cover}
  carcass: {kind: EP, thickness: 5 mm, mass: 6 kg/m^2, strength: 1000 N/mm}
idlers:
  carry:
    rolls: 3
    spacing: 1.2 m
    trough_angle: 35 deg
    roll: {diameter: 133 mm, length: 380 mm, rotating_mass: 4 kg}
  return:
    rolls: 1
    spacing: 3 m
    roll: {diameter: 133 mm, length: 1150 mm, rotating_mass: 9 kg}
material: {name: gravel, density: 1600 kg/m^3, flow: 900 t/h, surcharge_angle: 20 deg}
route:
  sections:
    - {name: one, length: 100 m}
    - {name: two, length: 200 m, lift: 10 m}
drive: {wrap_angle: 200 deg, friction: 0.35, efficiency: 93 %}
ambient: {temperature: 20 degC}
"""
"""A spec without fault, compact enough to count its lines by eye."""

Arguments = Sequence[str]


@dataclass(frozen=True)
class Case:
    """An input, what is run on it, and what has to come of it."""

    group: str
    title: str
    arrange: Callable[[Path], Arguments]
    """Writes the files into a folder, gives the arguments."""
    says: str
    """Part of the message."""
    code: int = 2
    lines: int = 1
    """Lines of the message: one for each thing that is wrong."""
    spoil: Callable[[pytest.MonkeyPatch], None] | None = None

    @property
    def name(self) -> str:
        """Of the test."""
        return f"{self.group}: {self.title}"


def power(content: str | bytes, name: str = "spec.yaml") -> Callable[[Path], Arguments]:
    def arrange(folder: Path) -> Arguments:
        data = content.encode() if isinstance(content, str) else content
        (folder / name).write_bytes(data)
        return ("power", name)

    return arrange


def edited(*changes: tuple[str, str]) -> Callable[[Path], Arguments]:
    text = SPEC
    for old, new in changes:
        assert text.count(old) >= 1, old
        text = text.replace(old, new, 1)
    return power(text)


def given(*arguments: str) -> Callable[[Path], Arguments]:
    def arrange(folder: Path) -> Arguments:
        (folder / "spec.yaml").write_text(SPEC, encoding="utf-8")
        return arguments

    return arrange


def folder_named(name: str, *arguments: str) -> Callable[[Path], Arguments]:
    def arrange(folder: Path) -> Arguments:
        (folder / name).mkdir()
        return given(*arguments)(folder)

    return arrange


def pipe_named(name: str, *arguments: str) -> Callable[[Path], Arguments]:
    def arrange(folder: Path) -> Arguments:
        os.mkfifo(folder / name)
        return given(*arguments)(folder)

    return arrange


def as_json(change: Callable[[str], str]) -> Callable[[Path], Arguments]:
    from ruamel.yaml import YAML

    return power(change(json.dumps(YAML(typ="safe", pure=True).load(SPEC), indent=1)), "spec.json")


ALIASES = "\n".join(
    ["a0: &a0 [x, x, x, x, x, x, x, x, x, x]"]
    + [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]" for i in range(1, 10)]
)

# -- workbooks


def book(change: Callable[[bytes], bytes], name: str = "input.xlsx") -> Callable[[Path], Arguments]:
    def arrange(folder: Path) -> Arguments:
        from conveyor.template.write import write_template

        path = write_template(folder / "input.xlsx")
        content = change(path.read_bytes())
        path.unlink()
        (folder / name).write_bytes(content)
        return ("power", name)

    return arrange


def cells(change: Callable[[Any], None]) -> Callable[[bytes], bytes]:
    def changed(content: bytes) -> bytes:
        from openpyxl import load_workbook

        book, stream = load_workbook(io.BytesIO(content)), io.BytesIO()
        change(book)
        book.save(stream)
        return stream.getvalue()

    return changed


def typed(value: Any, key: str = "belt.width", column: int = 2) -> Callable[[bytes], bytes]:
    """Type something into the value cell (column 2) or unit cell (3) of a field."""

    def change(book: Any) -> None:
        for sheet in book.worksheets:
            for row in range(1, sheet.max_row + 1):
                if sheet.cell(row, 7).value == key:
                    sheet.cell(row, column).value = value

    return cells(change)


def without_sheet(name: str) -> Callable[[bytes], bytes]:
    return cells(lambda book: book.remove(book[name]))


def renamed_sheet(old: str, new: str) -> Callable[[bytes], bytes]:
    def change(book: Any) -> None:
        book[old].title = new

    return cells(change)


def only_sheet(name: str) -> Callable[[bytes], bytes]:
    def change(book: Any) -> None:
        for sheet in list(book.worksheets)[1:]:
            book.remove(sheet)
        book.worksheets[0].title = name
        book.worksheets[0].delete_rows(1, 1000)

    return cells(change)


def bomb(_: bytes) -> bytes:
    """An archive of 40 kB that unpacks to 40 MB."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("[Content_Types].xml", "<Types/>")
        archive.writestr("xl/workbook.xml", b" " * 40_000_000)
    return stream.getvalue()


def entities(content: bytes) -> bytes:
    """Declare entities that refer to each other in the workbook part."""
    stream = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(content)) as old, zipfile.ZipFile(stream, "w") as new:
        for part in old.namelist():
            data = old.read(part)
            if part == "xl/workbook.xml":
                start = data.index(b"<workbook")
                data = data[:start] + b'<!DOCTYPE x [<!ENTITY a "b"><!ENTITY c "&a;&a;">]>' + data[start:]
            new.writestr(part, data)
    return stream.getvalue()


PROTECTED = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600) + "EncryptedPackage".encode("utf-16-le") + bytes(400)
OLD_XLS = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(1000)

# -- compounds and laboratory files


def compound(content: str | bytes, reference: str = "mine.yaml") -> Callable[[Path], Arguments]:
    def arrange(folder: Path) -> Arguments:
        data = content.encode() if isinstance(content, str) else content
        (folder / "mine.yaml").write_bytes(data)
        text = SPEC.replace("bottom_cover: {thickness: 4 mm, compound: standard-cover}",
                            f"bottom_cover: {{thickness: 4 mm, compound: {reference}}}")  # fmt: skip
        return power(text)(folder)

    return arrange


def two_shelves(folder: Path) -> Arguments:
    source = (Path(__file__).parents[2] / "materials" / "s100.yaml").read_text(encoding="utf-8")
    for name in ("ours", "theirs"):
        (folder / name).mkdir()
        (folder / name / "house.yaml").write_text(source, encoding="utf-8")
    text = SPEC.replace("compound: standard-cover", "compound: house", 1)
    return (*power(text)(folder), "--shelf", "ours", "--shelf", "theirs")


def laboratory(content: str | bytes, *arguments: str, name: str = "data.csv") -> Callable[[Path], Arguments]:
    def arrange(folder: Path) -> Arguments:
        (folder / name).write_bytes(content.encode() if isinstance(content, str) else content)
        return ("fit", name, *arguments)

    return arrange


MASTER = "frequency_Hz,storage_MPa,loss_MPa\n" + "".join(
    f"{10.0**k:g},{5.0 + k:g},{0.5 + 0.1 * k:g}\n" for k in range(6)
)

# -- disks


def full(patched: pytest.MonkeyPatch) -> None:
    """Half of a file, then no space left on the disk."""

    def half(self: Path, data: Any, *_: Any, **__: Any) -> int:
        binary = data.encode() if isinstance(data, str) else bytes(data)
        with self.open("wb") as stream:
            stream.write(binary[: len(binary) // 2])
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(self))

    patched.setattr(Path, "write_text", half)
    patched.setattr(Path, "write_bytes", half)


def unreadable(patched: pytest.MonkeyPatch) -> None:
    """A file that is there and may not be read (root may read all, so the refusal is simulated)."""

    def refused(self: Path) -> bytes:
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(self))

    patched.setattr(Path, "read_bytes", refused)


def read_only(patched: pytest.MonkeyPatch) -> None:
    """What is there may be read and not written."""
    patched.setattr(os, "access", lambda path, mode: not (mode & os.W_OK and Path(path).is_file()))


def read_only_folder(patched: pytest.MonkeyPatch) -> None:
    patched.setattr(os, "access", lambda path, mode: not (mode & os.W_OK and Path(path).is_dir()))


def stopped(patched: pytest.MonkeyPatch) -> None:
    """Ctrl-C in the middle of a calculation."""
    import conveyor.analysis

    def interrupted(_: Any) -> None:
        raise KeyboardInterrupt

    patched.setattr(conveyor.analysis, "analyse", interrupted)


def older(name: str, *arguments: str) -> Callable[[Path], Arguments]:
    """A file of that name is there from before."""

    def arrange(folder: Path) -> Arguments:
        (folder / name).write_bytes(b"from before")
        return given(*arguments)(folder)

    return arrange


YAML_SYNTAX = [
    Case("YAML", "a bracket left open", edited(("ambient: {temperature: 20 degC}", "ambient: {temperature: 20 degC")), "spec.yaml:25:10 syntax"),
    Case("YAML", "tab as indentation", edited(("  width: 1000 mm", "\twidth: 1000 mm")), "indent with spaces, not tabs"),
    Case("YAML", "indented one blank too far", edited(("  speed: 3 m/s", "   speed: 3 m/s")), "spec.yaml:4:"),
    Case("YAML", "no blank after the colon", edited(("name: Small", "name:Small")), "spec.yaml:"),
    Case("YAML", "a colon inside a value", edited(("name: Small", "name: Small: second draft")), "spec.yaml:1:12 syntax"),
    Case("YAML", "a quote left open", edited(("name: Small", 'name: "Small')), "spec.yaml:1:7 syntax"),
    Case("YAML", "a key given twice", edited(("  speed: 3 m/s", "  speed: 3 m/s\n  speed: 4 m/s")), "given twice, first in line 4"),
    Case("YAML", "an alias of nothing", edited(("width: 1000 mm", "width: *w")), "spec.yaml:3:10 syntax"),
    Case("YAML", "a tag that would run code", edited(("name: Small", "name: !!python/object/apply:os.system [ls]")), "the tag"),
    Case("YAML", "a merge key", edited(("ambient: {", "ambient: {<<: {a: 1}, ")), "merge keys (<<) are not allowed"),
    Case("YAML", "two documents in a file", power(SPEC + "---\n" + SPEC), "spec.yaml:26:1 syntax"),
    Case("YAML", "nothing in the file", power(""), "spec.yaml:1:1 file: empty"),
    Case("YAML", "comments only", power("# to do\n"), "spec.yaml:1:1 file: empty"),
    Case("YAML", "a list for the mapping", power("- name: Small\n"), "expected a mapping of fields (key: value), got a list"),
    Case("YAML", "a single word", power("conveyor\n"), "got a single value"),
    Case("YAML", "a control character", power(SPEC.replace("Small", "Sm\x07all")), "spec.yaml:1:9 syntax"),
    Case("YAML", "nested sixty deep", power("a: " + "[" * 60 + "]" * 60), "nested deeper than 50 levels"),
    Case("YAML", "nested a hundred thousand deep", power("a: " + "[" * 100_000), "nested deeper than 50 levels"),
    Case("YAML", "an alias of itself", power("a: &a [*a]\n"), "nested deeper than 50 levels"),
    Case("YAML", "aliases that multiply to 10^10 values", power(ALIASES), "more than 100,000 values, aliases expanded"),
    Case("YAML", "a megabyte", power(SPEC + "# filler\n" * 120_000), "larger than 500,000 bytes"),
]  # fmt: skip

ENCODINGS = [
    Case("encoding", "UTF-16 with its mark", power(SPEC.encode("utf-16")), "spec.yaml:1:1 file: UTF-16 text, expected UTF-8"),
    Case("encoding", "UTF-16 without its mark", power(SPEC.encode("utf-16-le")), "spec.yaml:1:2 "),
    Case("encoding", "UTF-32", power(SPEC.encode("utf-32")), "UTF-32 text, expected UTF-8"),
    Case("encoding", "an umlaut in Latin-1", power(SPEC.replace("gravel", "Schüttgut").encode("latin-1")), "spec.yaml:18:20 file: not UTF-8 text (byte 0xfc)"),
    Case("encoding", "a mark and a missing field", power(b"\xef\xbb\xbf" + SPEC.replace("name: Small\n", "").encode()), "spec.yaml:1:1 name: missing"),
    Case("encoding", "a picture named .yaml", power(b"\x89PNG\r\n\x1a\n" + bytes(64)), "spec.yaml:1:1 file: not UTF-8 text"),
]  # fmt: skip

JSON = [
    Case("JSON", "a comma too many", as_json(lambda text: text[:-2] + ",\n}"), "spec.json:"),
    Case("JSON", "single quotes", as_json(lambda text: text.replace('"', "'")), "spec.json:2:2 syntax"),
    Case("JSON", "NaN for a number", as_json(lambda text: text.replace("0.35", "NaN")), "drive.friction: "),
    Case("JSON", "a number without a unit", as_json(lambda text: text.replace('"1000 mm"', "1000")), "spec.json:4:12 belt.width: got 1000 without a unit"),
    Case("JSON", "cut off", as_json(lambda text: text[: len(text) // 2]), "spec.json:"),
    Case("JSON", "a key given twice", as_json(lambda text: text.replace('"name": "Small"', '"name": "Small", "name": "Big"')), "given twice"),
    Case("JSON", "a number of 5000 digits", as_json(lambda text: text.replace("0.35", "9" * 5000)), "spec.json:"),
]  # fmt: skip

VALUES = [
    Case("value", "no unit", edited(("width: 1000 mm", "width: 1000")), 'spec.yaml:3:10 belt.width: got 1000 without a unit; give the unit, e.g. "1000 mm"'),
    Case("value", "a unit of another dimension", edited(("width: 1000 mm", "width: 1000 kg")), "(a mass), expected a length"),
    Case("value", "a misspelt unit", edited(("width: 1000 mm", "width: 1000 milimeter")), 'unknown unit "milimeter"'),
    Case("value", "an ambiguous ton", edited(("flow: 900 t/h", "flow: 900 ton/h")), '"ton" is ambiguous; write "900 t/h" (metric) or "900 short_ton/h"'),
    Case("value", "C for degC", edited(("temperature: 20 degC", "temperature: 20 C")), 'did you mean "20 degC"'),
    Case("value", "a decimal comma", edited(("spacing: 1.2 m", "spacing: '1,2 m'")), "a comma is ambiguous"),
    Case("value", "a blank between thousands", edited(("width: 1000 mm", "width: 1 000 mm")), "write the number without a thousands sign"),
    Case("value", "not a number", edited(("width: 1000 mm", "width: nan mm")), "expected a finite number"),
    Case("value", "infinite", edited(("friction: 0.35", "friction: .inf")), "drive.friction: "),
    Case("value", "too large for a float", edited(("width: 1000 mm", "width: 1e999 mm")), "belt.width: "),
    Case("value", "five thousand digits", edited(("friction: 0.35", "friction: " + "9" * 5000)), "drive.friction: "),
    Case("value", "an expression", edited(("width: 1000 mm", "width: 9**9**9 mm")), "belt.width: "),
    Case("value", "out of range", edited(("width: 1000 mm", "width: 12 m")), "got 12 m, allowed: >= 100 mm and <= 5 m"),
    Case("value", "negative", edited(("speed: 3 m/s", "speed: -3 m/s")), "got -3 m/s, allowed: > 0 m/s"),
    Case("value", "below absolute zero", edited(("temperature: 20 degC", "temperature: -300 degC")), "ambient.temperature: got -300 degC"),
    Case("value", "yes for a number", edited(("friction: 0.35", "friction: yes")), "drive.friction: "),
    Case("value", "true for a quantity", edited(("width: 1000 mm", "width: true")), "belt.width: expected a length"),
    Case("value", "text for a count", edited(("rolls: 3", "rolls: three")), "idlers.carry.rolls: got \"three\", allowed: 1, 2, 3"),
    Case("value", "a fraction of a count", edited(("rolls: 3", "rolls: 2.5")), "idlers.carry.rolls: got 2.5, allowed: 1, 2, 3"),
    Case("value", "a list for a mapping", edited(("drive: {wrap_angle: 200 deg, friction: 0.35, efficiency: 93 %}", "drive: [200 deg, 0.35]")), "drive: expected a mapping of fields, got a list"),
    Case("value", "a mapping for a list", edited(("    - {name: one, length: 100 m}\n    - {name: two, length: 200 m, lift: 10 m}", "    one: {length: 100 m}")), "route.sections: expected a list, got a mapping"),
    Case("value", "a mapping for a quantity", edited(("width: 1000 mm", "width: {value: 1000, unit: mm}")), "belt.width: expected a length such as \"1200 mm\", got a mapping"),
    Case("value", "nothing behind a key", edited(("width: 1000 mm", "width:")), "belt.width: "),
    Case("value", "an empty name", edited(("name: Small", 'name: ""')), "name: empty"),
    Case("value", "an empty list", edited(("  sections:\n    - {name: one, length: 100 m}\n    - {name: two, length: 200 m, lift: 10 m}", "  sections: []")), "route.sections: got 0 entries, at least 1 needed"),
    Case("value", "a word that is not offered", edited(("kind: EP", "kind: EPP")), "belt.carcass.kind: got \"EPP\", allowed: 'steel cord', 'EP'"),
    Case("value", "colours for the terminal in a name", edited(("kind: EP", r'kind: "\e[31mEP"')), r"\x1b[31mEP"),
    Case("value", "a line break in a word", edited(("kind: EP", r'kind: "E\nP"')), r"E\nP"),
    Case("value", "text from right to left", edited(("kind: EP", 'kind: "\u202eEP"')), r"\u202eEP"),
    Case("value", "a word of 10,000 letters", edited(("kind: EP", "kind: " + "x" * 10_000)), "..., allowed:"),
    Case("value", "three things wrong", edited(("width: 1000 mm", "width: 1000"), ("speed: 3 m/s", "speed: fast"), ("friction: 0.35", "friction: 3")), "belt.speed", lines=3),
]  # fmt: skip

FIELDS = [
    Case("field", "missing", edited(("  width: 1000 mm\n", "")), "belt.width: missing; expected a length"),
    Case("field", "a whole part missing", edited(("ambient: {temperature: 20 degC}\n", "")), "ambient: missing; expected fields: temperature"),
    Case("field", "misspelt", edited(("  speed: 3 m/s\n", "  speed: 3 m/s\n  thicknes: 15 mm\n")), 'unknown key "thicknes"; did you mean "thickness"?'),
    Case("field", "of another part", edited(("  speed: 3 m/s\n", "  speed: 3 m/s\n  wrap_angle: 200 deg\n")), 'unknown key "wrap_angle"'),
    Case("field", "hostile key", edited(("  speed: 3 m/s\n", '  speed: 3 m/s\n  "\\e]0;x\\a": 1\n')), r"\x1b]0;x"),
    Case("field", "key of 10,000 letters", edited(("  speed: 3 m/s\n", "  speed: 3 m/s\n  " + "k" * 10_000 + ": 1\n")), "spec.yaml:5:3"),
    Case("field", "a list as a key", edited(("  speed: 3 m/s\n", "  speed: 3 m/s\n  ? [a, b]\n  : 1\n")), "expected text before the colon"),
    Case("field", "a number as a key", edited(("  speed: 3 m/s\n", "  speed: 3 m/s\n  1: 2\n")), 'unknown key "1"'),
    Case("contradiction", "covers and carcass against the thickness", edited(("  speed: 3 m/s\n", "  speed: 3 m/s\n  thickness: 20 mm\n")), "belt.thickness: got 20 mm, but top cover + bottom cover + carcass"),
    Case("contradiction", "lift and slope", edited(("lift: 10 m", "lift: 10 m, slope: 2 deg")), "route.sections[1]"),
    Case("contradiction", "steeper than its length", edited(("lift: 10 m", "lift: 300 m")), "route.sections[1].lift"),
    Case("contradiction", "a trough of one roll", edited(("    rolls: 3", "    rolls: 1")), "but one roll lies flat", lines=2),
    Case("contradiction", "more bulk than the trough holds", edited(("flow: 900 t/h", "flow: 9000 t/h")), "material.flow"),
    Case("contradiction", "rolls that overlap", edited(("spacing: 1.2 m", "spacing: 120 mm")), "rolls of neighbouring sets overlap"),
    Case("contradiction", "a section twice", edited(("name: two", "name: one")), "route.sections[1].name"),
]  # fmt: skip

SHELF = [
    Case("compound", "misspelt name", edited(("compound: standard-cover}\n  bottom", "compound: standart-cover}\n  bottom")), 'did you mean "standard-cover"?'),
    Case("compound", "no such file", edited(("compound: standard-cover}\n  bottom", "compound: rubber/mine.yaml}\n  bottom")), "rubber/mine.yaml: no such file"),
    Case("compound", "a null byte in its name", edited(("compound: standard-cover}\n  bottom", 'compound: "mi\\0ne.yaml"}\n  bottom')), "no name of a file"),
    Case("compound", "somebody's home that is not there", edited(("compound: standard-cover}\n  bottom", "compound: ~nobody-here/mine.yaml}\n  bottom")), 'no home folder "~nobody-here"'),
    Case("compound", "its file has errors", compound("name: mine\nkind: measured\npoisson_ratio: half\n"), 'mine.yaml:3:16 poisson_ratio: expected a number, got "half"', lines=5),
    Case("compound", "its file is no YAML", compound("name: [mine\n"), "mine.yaml:1:7 syntax"),
    Case("compound", "its file is a spec", compound(SPEC), "mine.yaml", lines=13),
    Case("compound", "its file is a folder", folder_named("mine.yaml", "shelf", "mine.yaml"), "mine.yaml: is a folder; give a file in it"),
    Case("compound", "its file is a pipe", pipe_named("mine.yaml", "shelf", "mine.yaml"), "mine.yaml: is no ordinary file"),
    Case("compound", "two of a name", two_shelves, 'compound "house" is on the shelf twice: ours/house.yaml and theirs/house.yaml'),
    Case("compound", "a shelf that is not there", given("power", "spec.yaml", "--shelf", "nowhere"), "shelf nowhere: no such folder"),
    Case("compound", "a file for a shelf", given("power", "spec.yaml", "--shelf", "spec.yaml"), "shelf spec.yaml: no such folder"),
    Case("compound", "unknown on the command line", given("compare", "spec.yaml", "-c", "s101"), 'unknown compound "s101"; did you mean "s100"?'),
    Case("compound", "far outside its temperatures", edited(("temperature: 20 degC", "temperature: -90 degC")), "ambient.temperature"),
]  # fmt: skip

WORKBOOKS = [
    Case("workbook", "no such file", given("power", "none.xlsx"), "none.xlsx: no such file"),
    Case("workbook", "empty", book(lambda _: b""), "input.xlsx: empty"),
    Case("workbook", "text named .xlsx", book(lambda _: SPEC.encode()), "input.xlsx: not a workbook (.xlsx)"),
    Case("workbook", "an .xls renamed", book(lambda _: OLD_XLS), "not a workbook of the .xlsx format; save it as .xlsx"),
    Case("workbook", "an .xls", book(lambda _: OLD_XLS, "input.xls"), "input.xls"),
    Case("workbook", "with a password", book(lambda _: PROTECTED), "protected by a password; save it without one"),
    Case("workbook", "cut off in the middle", book(lambda content: content[: len(content) // 2]), "damaged or incomplete"),
    Case("workbook", "a byte flipped", book(lambda c: c[:3000] + bytes([c[3000] ^ 0xFF]) + c[3001:]), "damaged or incomplete"),
    Case("workbook", "40 kB that unpack to 40 MB", book(bomb), "unpacks to more than 10,000,000 bytes"),
    Case("workbook", "entities that multiply", book(entities), "input.xlsx: "),
    Case("workbook", "4 MB", book(lambda content: content + bytes(4_000_000)), "larger than 3,000,000 bytes"),
    Case("workbook", "somebody else's", book(only_sheet("Sheet1")), "input.xlsx: "),
    Case("workbook", "a sheet gone", book(without_sheet("Belt")), "Belt"),
    Case("workbook", "a sheet renamed", book(renamed_sheet("Belt", "Gurt")), "Belt"),
    Case("workbook", "a value emptied", book(typed(None)), "belt.width: missing; expected a length"),
    Case("workbook", "a misspelt unit", book(typed("milimeter", column=3)), 'unknown unit "milimeter"'),
    Case("workbook", "text for a number", book(typed("wide")), "belt.width"),
    Case("workbook", "a formula without a result", book(typed("=A1*2")), "formula without a result"),
    Case("workbook", "an error in a cell", book(typed("#REF!")), "holds the error #REF!"),
    Case("workbook", "a folder", folder_named("input.xlsx", "power", "input.xlsx"), "input.xlsx: is a folder"),
    Case("workbook", "a pipe", pipe_named("input.xlsx", "power", "input.xlsx"), "input.xlsx: is no ordinary file"),
]  # fmt: skip

LABORATORY = [
    Case("laboratory", "no such file", given("fit", "none.csv"), "none.csv: no such file"),
    Case("laboratory", "no table in it", laboratory("hello\n"), "data.csv"),
    Case("laboratory", "no unit for the moduli", laboratory(MASTER.replace("_MPa", "")), "--modulus-unit"),
    Case("laboratory", "no temperature stated", laboratory(MASTER), '--at "20 degC"'),
    Case("laboratory", "a negative modulus", laboratory(MASTER.replace("100,7", "100,-7"), "--at", "20 degC"), "data.csv: row 4"),
    Case("laboratory", "an .xls", laboratory(OLD_XLS, name="data.xls"), "old .xls workbook"),
    Case("laboratory", "40 kB that unpack to 120 MB", laboratory(b"", name="data.xlsx"), ""),
    Case("laboratory", "a folder", folder_named("data.csv", "fit", "data.csv"), "data.csv: is a folder"),
    Case("laboratory", "a pipe", pipe_named("data.csv", "fit", "data.csv"), "data.csv: is no ordinary file"),
]  # fmt: skip

PATHS = [
    Case("path", "no such file", given("power", "none.yaml"), "none.yaml: no such file"),
    Case("path", "a folder", folder_named("specs", "power", "specs"), "specs"),
    Case("path", "a folder named .yaml", folder_named("s.yaml", "power", "s.yaml"), "s.yaml: is a folder; give a file in it"),
    Case("path", "a pipe named .yaml", pipe_named("s.yaml", "power", "s.yaml"), "s.yaml: is no ordinary file"),
    Case("path", "an ending nobody reads", given("power", "spec.toml"), "ends in .yaml, .yml or .json"),
    Case("path", "a name of 300 letters", given("power", "x" * 300 + ".yaml"), "cannot be read"),
    Case("path", "may not be read", given("power", "spec.yaml"), "spec.yaml: cannot be read: Permission denied", spoil=unreadable),
]  # fmt: skip

OUTPUTS = [
    Case("output", "workbook into a missing folder", given("power", "spec.yaml", "-o", "out/r.xlsx"), "out/r.xlsx: its folder does not exist"),
    Case("output", "workbook onto a folder", folder_named("r.xlsx", "power", "spec.yaml", "-o", "r.xlsx"), "r.xlsx: is a folder"),
    Case("output", "workbook onto a pipe", pipe_named("r.xlsx", "power", "spec.yaml", "-o", "r.xlsx"), "r.xlsx: is no ordinary file"),
    Case("output", "workbook of another ending", given("power", "spec.yaml", "-o", "r.docx"), "a workbook's name ends in .xlsx"),
    Case("output", "workbook onto a read-only one", older("r.xlsx", "power", "spec.yaml", "-o", "r.xlsx"), "r.xlsx: is read-only", spoil=read_only),
    Case("output", "workbook into a read-only folder", given("power", "spec.yaml", "-o", "r.xlsx"), "r.xlsx: its folder is read-only", spoil=read_only_folder),
    Case("output", "disk full, workbook, an older one there", older("r.xlsx", "power", "spec.yaml", "-o", "r.xlsx"), "r.xlsx: cannot be written (No space left on device)", spoil=full),
    Case("output", "disk full, table of scenes", older("t.csv", "compare", "spec.yaml", "-c", "s100", "--csv", "t.csv"), "t.csv: cannot be written (No space left on device)", spoil=full),
    Case("output", "disk full, compound file", older("c.yaml", "fit", str(Path(__file__).parents[2] / "materials" / "s100.dma.csv"), "-q", "-o", "c.yaml"), "c.yaml: cannot be written (No space left on device)", spoil=full),
    Case("output", "disk full, starter", older("n.yaml", "new", "n.yaml", "--force"), "n.yaml: cannot be written (No space left on device)", spoil=full),
    Case("output", "disk full, template", older("t.xlsx", "template", "t.xlsx"), "t.xlsx: cannot be written (No space left on device)", spoil=full),
    Case("output", "starter onto an older spec", given("new", "spec.yaml"), "spec.yaml: exists; choose another name, or replace it with --force"),
    Case("output", "starter of another ending", given("new", "mine.txt"), "a spec's name ends in .yaml"),
    Case("output", "template into a missing folder", given("template", "out/t.xlsx"), "out/t.xlsx"),
    Case("output", "figure into a missing folder", given("shelf", "s100", "--plot", "out/f.png"), "out/f.png"),
    Case("output", "figure of another ending", given("shelf", "s100", "--plot", "f.bmp"), "ends in .png, .svg or .pdf"),
]  # fmt: skip

COMMANDS = [
    Case("command line", "misspelt command", given("powr", "spec.yaml"), "'power'"),
    Case("command line", "command left out", given("spec.yaml"), "conveyor power spec.yaml"),
    Case("command line", "misspelt option", given("power", "spec.yaml", "--quite"), "did you mean --quiet?"),
    Case("command line", "option of another command", given("power", "spec.yaml", "--radius", "1"), "no such option: --radius"),
    Case("command line", "nothing to calculate", given("power"), "conveyor power: missing argument"),
    Case("command line", "one argument too many", given("power", "spec.yaml", "other.yaml"), "other.yaml"),
    Case("command line", "text for a number", given("contact", "--radius", "big", "--pressure", "1"), "--radius"),
    Case("command line", "a word that is not offered", given("new", "x.yaml", "--kind", "tunnel"), "'overland', 'in-plant'"),
    Case("command line", "a range that leads nowhere", given("compare", "spec.yaml", "-c", "s100", "--temperature", "20:0:5"), "expected from:to:step"),
    Case("no answer", "a free cover wrapped around the roll", edited(("ambient: {", "calculation: {support: free}\nambient: {")), "confined", code=1),
    Case("no answer", "a temperature that no compound reaches", given("compare", "spec.yaml", "-c", "s100", "--temperature", "-90"), "no scene has an answer", code=1),
    Case("no answer", "one contact too heavily loaded", given("contact", "--support", "free", "--radius", "0.1", "--thickness", "0.05", "--pressure", "0.5"), "lower the load", code=1),
    Case("stopped", "Ctrl-C while it calculates", older("r.xlsx", "power", "spec.yaml", "-o", "r.xlsx"), "conveyor: stopped by Ctrl-C", code=130, spoil=stopped),
]  # fmt: skip

CASES = [*YAML_SYNTAX, *ENCODINGS, *JSON, *VALUES, *FIELDS, *SHELF, *WORKBOOKS, *LABORATORY, *PATHS, *OUTPUTS, *COMMANDS]
