"""What people and disks do to files: functions that lay the input of a case out in a folder."""

from __future__ import annotations

import errno
import io
import json
import os
import tempfile
import zipfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
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


@cache
def template() -> bytes:
    from conveyor.starter.template_writer import write_template

    with tempfile.TemporaryDirectory() as folder:
        return write_template(Path(folder) / "input.xlsx").read_bytes()


def book(change: Callable[[bytes], bytes], *options: str, name: str = "input.xlsx") -> Callable[[Path], Arguments]:
    def arrange(folder: Path) -> Arguments:
        (folder / name).write_bytes(change(template()))
        return ("power", name, *options)

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


def bomb(size: int) -> bytes:
    """An archive of a thousandth of what it unpacks to."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("[Content_Types].xml", "<Types/>")
        archive.writestr("xl/workbook.xml", bytes(size))
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


MASTER = "frequency_Hz,E'_MPa,E''_MPa\n" + "".join(f"{10.0**k:g},{5.0 + k:g},{0.5 + 0.1 * k:g}\n" for k in range(6))

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
    import conveyor.results.analysis

    def interrupted(_: Any) -> None:
        raise KeyboardInterrupt

    patched.setattr(conveyor.results.analysis, "analyse", interrupted)


def older(name: str, *arguments: str) -> Callable[[Path], Arguments]:
    """A file of that name is there from before."""

    def arrange(folder: Path) -> Arguments:
        (folder / name).write_bytes(b"from before")
        return given(*arguments)(folder)

    return arrange
