"""Figures have settings of their own; what keeps them from being drawn is said in words."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import matplotlib as mpl
import pytest

from conveyor import shelf
from conveyor.errors import InputError
from conveyor.report import plots, svg
from conveyor.report.matplotlib_settings import own_settings
from tests import command_line

HOSTILE = {
    "text.usetex": True,
    "font.size": 31.0,
    "axes.facecolor": "red",
    "lines.linewidth": 9.0,
    "svg.fonttype": "none",
    "savefig.dpi": 30.0,
    "axes.formatter.use_locale": True,
}


def _figure():
    return plots.master_curve(shelf.compound("s100"), 293.15)


@pytest.mark.parametrize("ending", [".png", ".svg", ".pdf"])
def test_settings_of_the_user_do_not_reach_a_figure_and_come_back(ending):
    path = Path(f"f{ending}")
    plain = plots.figure_bytes(_figure(), path)
    with mpl.rc_context(HOSTILE):
        assert plots.figure_bytes(_figure(), path) == plain
        assert {key: mpl.rcParams[key] for key in HOSTILE} == HOSTILE
    with mpl.rc_context(HOSTILE):  # and the comparison sees such settings
        figure = plots.stacked_axes()[0]
        assert figure.axes[0].get_facecolor() == (1.0, 0.0, 0.0, 1.0)
        with own_settings():
            assert plots.stacked_axes()[0].axes[0].get_facecolor() == (1.0, 1.0, 1.0, 1.0)


def _drawn_elsewhere(folder, **variables):
    """A figure drawn by a process of its own, in a folder and with variables."""
    program = "from conveyor.cli import main; main()"
    command = [sys.executable, "-c", program, "shelf", "s100", "--plot", "f.png"]
    return subprocess.run(command, cwd=folder, env=os.environ | variables, capture_output=True, text=True, check=False)


def test_a_matplotlibrc_in_the_folder_is_left_alone(tmp_path):
    (tmp_path / "matplotlibrc").write_text("text.usetex: true\nfont.size: 31\n", encoding="utf-8")
    done = _drawn_elsewhere(tmp_path)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "f.png").read_bytes()[:4] == b"\x89PNG"


@pytest.mark.parametrize(
    ("variables", "said"),
    [
        ({"MPLBACKEND": "nonsense"}, 'correct or unset the variable (MPLBACKEND="nonsense")'),
        ({}, "correct its matplotlibrc, or correct or unset the variable (none of MPLBACKEND"),
    ],
)
def test_what_keeps_matplotlib_from_starting_is_refused_in_words(tmp_path, variables, said):
    if not variables:
        (tmp_path / "matplotlibrc").write_bytes(b"font.size: \xff\xfe31\n")
    done = _drawn_elsewhere(tmp_path, **variables)
    assert done.returncode == 2, done.stderr
    assert said in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert not (tmp_path / "f.png").exists()


@pytest.mark.parametrize("given", ["abc", "-5", "1.5", "9" * 30])
def test_a_date_that_is_none_is_refused(monkeypatch, given):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", given)
    with pytest.raises(InputError, match=r'SOURCE_DATE_EPOCH="[^"]+": expected whole seconds since 1970'):
        plots.figure_bytes(_figure(), Path("f.pdf"))
    with pytest.raises(InputError, match="SOURCE_DATE_EPOCH"):
        svg.figure_svg(_figure(), "f", "a figure")


def test_a_date_of_the_user_is_fine(monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    assert plots.figure_bytes(_figure(), Path("f.pdf")).startswith(b"%PDF")


def test_a_machine_without_memory_is_told_so():
    def none_left(patched):
        def refused(_):
            raise MemoryError

        patched.setattr("conveyor.results.analysis.analyse", refused)

    done = command_line.run("power", "examples/specs/shuttle.yaml", spoil=none_left)
    assert done.returncode == 1
    assert done.stderr.startswith("conveyor: this machine has no memory left for it; close other programs")
    assert len(done.stderr.splitlines()) == 1
