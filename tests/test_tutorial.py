"""The tutorial runs, prints what it promises, and its notebook holds the same cells.

``python -m tests.test_tutorial`` writes the notebook from the script, with its outputs.
"""

from __future__ import annotations

import ast
import base64
import contextlib
import io
import json
import os
import re
import tempfile
from pathlib import Path
from typing import Any

import pytest
from matplotlib.figure import Figure

from tests.test_docs import same

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


def run_cell(source: str, space: dict[str, Any]) -> tuple[str, Any]:
    """What a cell prints, and what its last line is."""
    tree, out, last = ast.parse(source), io.StringIO(), None
    with contextlib.redirect_stdout(out):
        shown = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
        exec(compile(tree, NOTEBOOK.name, "exec"), space)
        if isinstance(shown, ast.Expr):
            last = eval(compile(ast.Expression(shown.value), NOTEBOOK.name, "eval"), space)  # noqa: S307 our cells
    return out.getvalue(), last


def outputs(source: str, space: dict[str, Any], count: int) -> list[dict[str, Any]]:
    """What a notebook shows below a cell: its text, and its last line as a table or a picture."""
    printed, last = run_cell(source, space)
    found: list[dict[str, Any]] = []
    if printed:
        found.append({"name": "stdout", "output_type": "stream", "text": printed.splitlines(keepends=True)})
    data: dict[str, Any] = {}
    if isinstance(last, Figure):
        picture = io.BytesIO()
        last.savefig(picture, format="png", dpi=70, metadata={"Software": ""})
        data = {"image/png": base64.b64encode(picture.getvalue()).decode(), "text/plain": ["<Figure>"]}
    elif last is not None:
        data = {
            "text/html": last._repr_html_().splitlines(keepends=True),
            "text/plain": repr(last).splitlines(keepends=True),
        }
    if data:
        kind = {"output_type": "execute_result", "execution_count": count, "metadata": {}}
        found.append(kind | {"data": data})
    return found


def notebook(found: list[tuple[str, str]], space: dict[str, Any] | None = None) -> dict[str, Any]:
    """Return nbformat 4.5; with a space to run the cells in, their outputs."""
    written = []
    count = 0
    for number, (kind, body) in enumerate(found):
        cell: dict[str, Any] = {"cell_type": kind, "id": f"cell-{number}", "metadata": {}}
        if kind == "code":
            count += 1
            shown = [] if space is None else outputs(body, space, count)
            cell |= {"execution_count": None if space is None else count, "outputs": shown}
        written.append(cell | {"source": body.splitlines(keepends=True)})
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    about = {"kernelspec": kernel, "language_info": {"name": "python"}}
    return {"cells": written, "metadata": about, "nbformat": 4, "nbformat_minor": 5}


def as_text(data: dict[str, Any]) -> str:
    return json.dumps(data, indent=1, ensure_ascii=False) + "\n"


def shipped() -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"]
    return found


def test_notebook_holds_the_cells_of_the_script() -> None:
    expected = notebook(cells(SCRIPT.read_text(encoding="utf-8")))["cells"]
    for cell, other in zip(shipped(), expected, strict=True):
        assert cell["source"] == other["source"], "run: python -m tests.test_tutorial"
        assert cell["cell_type"] == other["cell_type"]


def test_cells_are_read_as_editors_read_them() -> None:
    text = '"""Head."""\n\n# %% [markdown]\n# # Title\n#\n# text\n\n# %%\na = 1  # %% no cell\n\n# %%\nb = 2\n'
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
    printed = ""
    for cell in shipped():
        if cell["cell_type"] == "code":
            told, last = run_cell("".join(cell["source"]), space)
            printed += told
            before = [one for one in cell["outputs"] if one["output_type"] == "stream"]
            same(told, "".join(before[0]["text"]) if before else "")
            kinds = [kind for one in cell["outputs"] for kind in one.get("data", ())]
            wanted = [] if last is None else ["image/png" if isinstance(last, Figure) else "text/html", "text/plain"]
            assert kinds == wanted
    for said in ("motor 1144.5 kW", "f = 0.0117", "standard cover:  1233.4 kW", "at -20 degC:  1921.0 kW"):
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
    with tempfile.TemporaryDirectory() as scratch:
        (Path(scratch) / "specs").symlink_to(ROOT / "examples" / "specs")
        os.chdir(scratch)
        made = notebook(cells(SCRIPT.read_text(encoding="utf-8")), {})
    NOTEBOOK.write_text(as_text(made), encoding="utf-8")
