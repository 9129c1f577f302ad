"""The README's Python runs as printed, and prints what it says."""

from __future__ import annotations

import contextlib
import io
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"```python\n(.*?)```\n(?:\n```text\n(.*?)```)?", TEXT, flags=re.DOTALL)


@pytest.mark.parametrize(("code", "printed"), BLOCKS)
def test_readme_block(code: str, printed: str, tmp_path, monkeypatch):
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        exec(compile(code, "README.md", "exec"), {})
    if printed:
        # six figures: forces hold to the contact's rtol of 1e-6
        numbers = [float(text) for text in re.findall(r"\d+\.\d+", out.getvalue())]
        assert numbers == pytest.approx([float(text) for text in re.findall(r"\d+\.\d+", printed)], rel=2e-6)
        assert re.sub(r"[\d.\s]+", " ", out.getvalue()) == re.sub(r"[\d.\s]+", " ", printed)


def test_readme_has_its_blocks():
    assert len(BLOCKS) == 2
    assert BLOCKS[0][1]
