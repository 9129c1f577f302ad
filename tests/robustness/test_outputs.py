"""Outputs: all of a command or none, links written through, files of others kept, same input same bytes."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest

import conveyor
from conveyor import shelf
from conveyor.errors import InputError
from conveyor.files.atomic_write import save_files
from conveyor.files.output_marks import output_kind
from conveyor.report import excel, html, plots, table_files
from conveyor.text.markup import Html
from tests.robustness.arrange import SPEC, Case, given
from tests.robustness.table import run

ESC = "a\x1b[31mb\x9bc"


def _line(**changes: object) -> conveyor.Conveyor:
    from ruamel.yaml import YAML

    return conveyor.spec.from_data(YAML(typ="safe", pure=True).load(SPEC) | changes)


@pytest.fixture(scope="module")
def result() -> conveyor.Analysis:
    return conveyor.analyse(_line())


def test_a_link_is_written_through(tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    target, link = tmp_path / "elsewhere" / "kept.txt", tmp_path / "link.txt"
    for older in (True, False):  # what it leads to is there, or not yet
        target.unlink(missing_ok=True)
        link.unlink(missing_ok=True)
        if older:
            target.write_bytes(b"older")
            target.chmod(0o640)
        link.symlink_to(target)
        save_files({link: b"new"})
        assert link.is_symlink()
        assert target.read_bytes() == b"new"
        assert not older or target.stat().st_mode & 0o777 == 0o640
    assert len(list(tmp_path.rglob("*"))) == 3


def test_links_in_a_circle_are_refused(tmp_path: Path) -> None:
    link = tmp_path / "link.txt"
    link.symlink_to(link)
    with pytest.raises(InputError, match=r"link\.txt: "):
        save_files({link: b"new"})


@pytest.mark.parametrize("later", range(3))
def test_a_rename_that_fails_takes_the_others_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, later: int) -> None:
    """As where one of the files is open in a spreadsheet program of Windows."""
    older, new, folder = tmp_path / "older.txt", tmp_path / "new.txt", tmp_path / "made"
    older.write_bytes(b"older")
    names = ["older.txt", "new.txt", "last.txt"]
    rename = Path.replace

    def refused(self: Path, target: Path) -> Path:
        if target.name == names[later] and self.read_bytes() == b"1":
            raise PermissionError(13, "Permission denied")
        return rename(self, target)

    monkeypatch.setattr(Path, "replace", refused)
    with pytest.raises(InputError, match="cannot be written"):
        save_files({older: b"1", new: b"1", folder / "last.txt": b"1"}, folders=[folder])
    assert {path.name for path in tmp_path.iterdir()} == {"older.txt"}
    assert older.read_bytes() == b"older"


def test_all_outputs_of_a_command_or_none(tmp_path: Path) -> None:
    """The page cannot be encoded on the way: neither the workbook nor the folder of tables appears."""

    def spoil(patched: pytest.MonkeyPatch) -> None:
        write = Path.write_bytes

        def half(self: Path, data: bytes) -> int:
            if b"<html" in bytes(data[:100]):
                raise OSError(28, "No space left on device")
            return write(self, data)

        patched.setattr(Path, "write_bytes", half)

    asked = ("power", "spec.yaml", "-o", "r.xlsx", "--tables", "t", "-o", "r.html")
    found = run(Case("output", "half", given(*asked), "", spoil=spoil), tmp_path)
    assert (found.code, found.out) == (2, "")
    assert "r.html: cannot be written (No space left on device)" in found.err
    assert found.after == found.before


def test_own_outputs_are_known_and_replaced(tmp_path: Path, result: conveyor.Analysis) -> None:
    figure = plots.master_curve(shelf.compound("s100"))
    book, page = tmp_path / "r.xlsx", str(html.build_page(result.contents())).encode()
    assert output_kind(excel.workbook_files(result.contents(), book)[book]) == "report workbook"
    assert output_kind(page) == "report page"
    for ending in (".png", ".svg", ".pdf"):
        assert output_kind(plots.figure_bytes(figure, Path(f"f{ending}"))) == "figure"
    si, us = (table_files.encode_tables(result.contents(system=system), tmp_path) for system in ("SI", "US"))
    assert {path: output_kind(content) for path, content in si.items()} == {
        path: output_kind(content) for path, content in us.items()
    }
    for foreign in (b"", b"PK", b"<html>", b"\x89PNG", b"name: x\n", b"a,b\r\n1,2\r\n", b"<svg></svg>"):
        assert output_kind(foreign) is None


def test_the_same_figure_has_the_same_bytes() -> None:
    for ending in (".svg", ".pdf", ".png"):
        one, two = (
            plots.figure_bytes(plots.master_curve(shelf.compound("s100")), Path(f"f{ending}")) for _ in range(2)
        )
        assert one == two


def test_pages_made_in_threads_are_those_made_in_turn(result: conveyor.Analysis) -> None:
    expected = html.build_page(result.contents())
    made: list[Html] = []
    threads = [threading.Thread(target=lambda: made.append(html.build_page(result.contents()))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert made == [expected] * 4


def test_control_characters_of_names_reach_no_output(tmp_path: Path) -> None:
    import json

    line = _line(name=ESC).as_data()
    line["route"]["sections"][0]["name"] = ESC
    line["report"] = {"project": ESC, "client": ESC}
    line["cases"] = [{"name": ESC}]
    text = json.dumps(line)
    asked = ("power", "spec.json", "-o", "r.xlsx", "--tables", "t", "-o", "r.html", "--plots", "p")

    def arrange(folder: Path) -> tuple[str, ...]:
        (folder / "spec.json").write_text(text, encoding="utf-8")
        return (*asked, "--plot-kind", "svg")

    found = run(Case("text", "controls", arrange, "", code=0), tmp_path)
    assert (found.code, found.err) == (0, "")
    assert r"a\x1b[31mb\x9bc" in found.out
    written = [
        found.out,
        *(p.read_text(encoding="utf-8") for s in ("svg", "csv", "html") for p in tmp_path.rglob(f"*.{s}")),
    ]
    assert len(written) > 20
    for one in written:
        assert not {"\x1b", "\x9b"} & set(one)
    shown = run(Case("text", "JSON", lambda _: ("power", "spec.json", "--json"), "", code=0), tmp_path).out
    assert json.loads(shown)["name"] == ESC
    assert not {"\x1b", "\x9b"} & set(shown)
