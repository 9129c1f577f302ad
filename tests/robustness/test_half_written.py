"""Every kind of output on a disk that runs full, and stopped in the middle: the older file stays, no other appears."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import pytest

import conveyor
from conveyor import shelf, starter
from conveyor.errors import InputError
from conveyor.files.atomic_write import save_files
from conveyor.report import plots
from conveyor.starter.template_writer import write_template
from tests import command_line
from tests.robustness.arrange import SPEC, full
from tests.robustness.table import files

_LEAST = 1000
"""Bytes that the full disk still takes: less than any of the outputs."""


@cache
def _line() -> conveyor.Conveyor:
    from ruamel.yaml import YAML

    return conveyor.spec.from_data(YAML(typ="safe", pure=True).load(SPEC))


@cache
def _analysis() -> conveyor.Analysis:
    return conveyor.analyse(_line())


@cache
def _comparison() -> conveyor.Comparison:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return conveyor.compare_compounds(_line(), ["standard-cover", "s100"])


def _figure(path: Path) -> object:
    return plots.save_figure(plots.master_curve(shelf.compound("s100"), 293.15), path)


OUTPUTS: dict[str, Callable[[Path], object]] = {
    "report.xlsx": lambda path: _analysis().to_excel(path),
    "report.html": lambda path: _analysis().to_html(path),
    "compounds.xlsx": lambda path: _comparison().to_excel(path),
    "scenes.csv": lambda path: save_files({path: (_comparison().table.to_csv(index=False) * 20).encode()}),
    "figure.png": _figure,
    "figure.svg": _figure,
    "compound.yaml": lambda path: save_files({path: shelf.dump(shelf.compound("s100"), "From a test").encode()}),
    "template.xlsx": lambda path: write_template(path, _line()),
    "starter.yaml": lambda path: save_files({path: starter.starter_text("overland").encode()}),
}
CHEAP = ["scenes.csv", "figure.svg", "compound.yaml", "starter.yaml"]
"""Those that take no second."""


@contextmanager
def _full_disk() -> Iterator[None]:
    """A real refusal of the system, whatever way is taken to write: no file may grow beyond a thousand bytes."""
    resource = pytest.importorskip("resource", reason="limits of POSIX")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (_LEAST, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.parametrize("name", OUTPUTS)
def test_a_full_disk_leaves_the_folder_as_it_was(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / name
    path.write_bytes(b"from before")
    before = files(tmp_path)
    with monkeypatch.context() as patched:
        full(patched)
        with pytest.raises(InputError, match=rf"{name}: cannot be written \(No space left on device\)"):
            OUTPUTS[name](path)
    assert files(tmp_path) == before


@pytest.mark.parametrize("older", [True, False])
@pytest.mark.parametrize("name", [*CHEAP, "report.xlsx", "template.xlsx"])
def test_a_disk_that_is_really_full_leaves_the_folder_as_it_was(name: str, older: bool, tmp_path: Path) -> None:
    OUTPUTS[name](tmp_path / name)  # what is written once, such as a cache of fonts, is there
    (tmp_path / name).unlink()
    path = tmp_path / name
    if older:
        path.write_bytes(b"from before")
    before = files(tmp_path)
    with _full_disk(), pytest.raises(InputError, match=rf"{name}: cannot be written \(File too large\)"):
        OUTPUTS[name](path)
    assert files(tmp_path) == before


@pytest.mark.parametrize("name", CHEAP)
def test_ctrl_c_while_it_writes_leaves_the_folder_as_it_was(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / name
    path.write_bytes(b"from before")
    before = files(tmp_path)

    def stopped(self: Path, *_: object, **__: object) -> int:
        with self.open("wb") as stream:
            stream.write(b"half")
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(Path, "write_bytes", stopped)
        patched.setattr(Path, "write_text", stopped)
        with pytest.raises(KeyboardInterrupt):
            OUTPUTS[name](path)
    assert files(tmp_path) == before


@pytest.mark.parametrize("command", [("template", "t.xlsx"), ("power", "spec.yaml", "-o", "t.xlsx")])
def test_a_command_names_the_file_that_found_no_room(command: tuple[str, ...], tmp_path: Path) -> None:
    (tmp_path / "spec.yaml").write_text(SPEC, encoding="utf-8")
    before = files(tmp_path)
    with _full_disk():
        done = command_line.run(*command, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (2, "t.xlsx: cannot be written (File too large)\n")
    assert files(tmp_path) == before


def _start(*arguments: str, unbuffered: str, folder: Path, **how: Any) -> subprocess.Popen[bytes]:
    """Start the command line as a shell does, its standard output with or without a buffer."""
    return subprocess.Popen(
        [sys.executable, "-m", "conveyor", *arguments],
        cwd=folder,
        env={**os.environ, "PYTHONUNBUFFERED": unbuffered, "PYTHONPATH": str(Path(conveyor.__file__).parents[1])},
        stderr=subprocess.PIPE,
        **how,
    )


@pytest.mark.parametrize("unbuffered", ["", "1"])
@pytest.mark.parametrize("command", [("schema",), ("power", "spec.yaml", "--json"), ("power", "spec.yaml")])
def test_output_that_its_file_does_not_take_is_an_error(
    command: tuple[str, ...], unbuffered: str, tmp_path: Path
) -> None:
    """Without a buffer Python's own writer leaves out, in silence, what did not fit: nothing said, exit code 0."""
    (tmp_path / "spec.yaml").write_text(SPEC, encoding="utf-8")
    with (tmp_path / "out").open("wb") as out, _full_disk():
        started = _start(*command, unbuffered=unbuffered, folder=tmp_path, stdout=out)
    _, said = started.communicate()
    assert (started.returncode, said) == (2, b"conveyor: output: File too large\n")
    assert (tmp_path / "out").stat().st_size == _LEAST


def test_a_workbook_that_finds_no_room_is_refused_in_one_line(tmp_path: Path) -> None:
    """To the end of the interpreter, which complains of what was left open."""
    (tmp_path / "spec.yaml").write_text(SPEC, encoding="utf-8")
    with _full_disk():
        started = _start(
            *("power", "spec.yaml", "-o", "t.xlsx"), unbuffered="", folder=tmp_path, stdout=subprocess.PIPE
        )
    shown, said = started.communicate()
    assert (started.returncode, shown, said) == (2, b"", b"t.xlsx: cannot be written (File too large)\n")


@pytest.mark.skipif(not hasattr(signal, "SIGPIPE"), reason="signals of POSIX")
@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_a_reader_that_goes_away_ends_the_command_in_silence(unbuffered: str, tmp_path: Path) -> None:
    """As `conveyor schema | head -1`: ended by the signal that shells expect."""
    started = _start("schema", unbuffered=unbuffered, folder=tmp_path, stdout=subprocess.PIPE)
    assert started.stdout is not None
    assert started.stdout.readline() == b"{\n"
    started.stdout.close()
    assert started.stderr is not None
    assert (started.stderr.read(), started.wait()) == (b"", -signal.SIGPIPE)
    started.stderr.close()
