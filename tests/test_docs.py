"""The commands of the docs run as printed."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from ruamel.yaml import YAML

import conveyor
import conveyor.spec
from conveyor.studies import studies

ROOT = Path(__file__).parent.parent
PAGES = sorted((ROOT / "docs").glob("*.md"))
REFUSED = "S100_strain_sweep.txt"  # the page shows what a doubtful file ends in


def commands() -> list[tuple[str, str]]:
    found = []
    for page in PAGES:
        for block in re.findall(r"```sh\n(.*?)```", page.read_text(encoding="utf-8"), flags=re.DOTALL):
            found += [(page.name, line) for line in block.splitlines() if line.startswith("conveyor ")]
    return found


@pytest.mark.parametrize(("page", "line"), commands())
def test_command_of_the_docs(page: str, line: str, tmp_path: Path) -> None:
    for folder in ("examples", "materials", "tests"):
        (tmp_path / folder).symlink_to(ROOT / folder)
    arguments = shlex.split(line.split("  #", maxsplit=1)[0])[1:]
    done = subprocess.run(
        [sys.executable, "-W", "error", "-m", "conveyor.cli", *arguments],
        cwd=tmp_path, capture_output=True, text=True, encoding="utf-8", check=False,
        env={**os.environ, "PYTHONIOENCODING": "utf-8"},
    )  # fmt: skip
    assert done.returncode == (2 if REFUSED in line else 0), f"{page}: {done.stderr}"
    if REFUSED in line:
        assert "--modulus-unit" in done.stderr
        assert "--strain-unit" in done.stderr
    for name in re.findall(r"(?:-o|--plot) (\S+)", line):
        assert REFUSED in line or (tmp_path / name).stat().st_size > 1000


def test_the_docs_have_commands() -> None:
    assert len(commands()) >= 6


@pytest.mark.parametrize(
    "page", [*PAGES, ROOT / "README.md", ROOT / "materials" / "README.md"], ids=lambda p: p.name
)
def test_links_and_pictures_exist(page: Path) -> None:
    for target in re.findall(r"\]\(([^)#]+?)(?:#[^)]*)?\)", page.read_text(encoding="utf-8")):
        if not target.startswith(("http://", "https://")):
            assert (page.parent / target).exists(), f"{page.name}: {target}"


def fragments() -> list[str]:
    text = (ROOT / "docs" / "conveyor.md").read_text(encoding="utf-8")
    return re.findall(r"```yaml\n(.*?)```", text, flags=re.DOTALL)


def merged(base: object, other: object) -> object:
    if isinstance(base, dict) and isinstance(other, dict):
        return base | {key: merged(base.get(key), value) for key, value in other.items()}
    return other


@pytest.mark.parametrize("number", range(len(fragments())))
def test_fragment_of_the_designers_page(number: int) -> None:
    overland = YAML(typ="safe").load(
        (ROOT / "examples" / "specs" / "overland.yaml").read_text(encoding="utf-8")
    )
    spec = merged(overland, YAML(typ="safe").load(fragments()[number]))
    line = conveyor.spec.from_data(spec)
    assert conveyor.analyse(line).balance.power.motor > 0.0
    studies(line)


def test_the_designers_page_has_its_fragments() -> None:
    assert len(fragments()) == 6
