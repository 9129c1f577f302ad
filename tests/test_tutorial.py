"""The tutorial runs, prints what it promises, and its notebook holds the same cells.

``python tests/test_tutorial.py`` writes the notebook from the script.
"""

from __future__ import annotations

import contextlib
import io
import json
import re
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parent.parent
SCRIPT = ROOT / "examples" / "06_tutorial.py"
NOTEBOOK = SCRIPT.with_suffix(".ipynb")
MARK = re.compile(r"^# %%(?: \[(markdown)\])?$", flags=re.MULTILINE)


def cells(script: str) -> list[tuple[str, str]]:
    """Kind and text of each cell, in the percent format; what stands before the first one is no cell."""
    parts = MARK.split(script)[1:]
    found = []
    for kind, text in zip(parts[0::2], parts[1::2], strict=True):
        body = text.strip("\n")
        if kind == "markdown":
            body = "\n".join(re.sub(r"^# ?", "", line) for line in body.splitlines())
        found.append((kind or "code", body))
    return found


def notebook(found: list[tuple[str, str]]) -> dict[str, Any]:
    """Return nbformat 4.5, without outputs."""
    written = []
    for number, (kind, body) in enumerate(found):
        cell: dict[str, Any] = {"cell_type": kind, "id": f"cell-{number}", "metadata": {}}
        if kind == "code":
            cell |= {"execution_count": None, "outputs": []}
        written.append(cell | {"source": body.splitlines(keepends=True)})
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    about = {"kernelspec": kernel, "language_info": {"name": "python"}}
    return {"cells": written, "metadata": about, "nbformat": 4, "nbformat_minor": 5}


def as_text(data: dict[str, Any]) -> str:
    return json.dumps(data, indent=1, ensure_ascii=False) + "\n"


def test_notebook_holds_the_cells_of_the_script() -> None:
    expected = as_text(notebook(cells(SCRIPT.read_text(encoding="utf-8"))))
    assert NOTEBOOK.read_text(encoding="utf-8") == expected, "run: python tests/test_tutorial.py"


def test_cells_are_read_as_editors_read_them() -> None:
    text = (
        '"""Head."""\n\n# %% [markdown]\n# # Title\n#\n# text\n\n# %%\na = 1  # %% no cell\n\n# %%\nb = 2\n'
    )
    assert cells(text) == [
        ("markdown", "# Title\n\ntext"),
        ("code", "a = 1  # %% no cell"),
        ("code", "b = 2"),
    ]


def test_tutorial_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As the cells of the notebook: from the folder of the examples, each in the space of those before it."""
    (tmp_path / "specs").symlink_to(ROOT / "examples" / "specs")
    monkeypatch.chdir(tmp_path)
    space: dict[str, Any] = {}
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        for cell in json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"]:
            if cell["cell_type"] == "code":
                exec(compile("".join(cell["source"]), NOTEBOOK.name, "exec"), space)
    printed = out.getvalue()
    for said in ("motor 1245.0 kW", "f = 0.0134", "standard cover:  1348.2 kW", "at -20 degC:  1876.3 kW"):
        assert said in printed
    left, right = space["solution"].patches[0]
    assert right > -left > 0.0  # reaches farther to the side that the belt comes from, as its text says
    inside = space["solution"].pressure(space["x"])
    assert (inside[5:] > inside[3::-1])[:-1].all()  # and presses harder there
    assert {path.name for path in (tmp_path / "tutorial").iterdir()} == {
        "overland.xlsx",
        "overland.html",
        "compounds.xlsx",
    }


if __name__ == "__main__":
    NOTEBOOK.write_text(as_text(notebook(cells(SCRIPT.read_text(encoding="utf-8")))), encoding="utf-8")
