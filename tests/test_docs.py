"""README and docs: commands and code run from top to bottom of each page and print what stands there; links hold."""

from __future__ import annotations

import contextlib
import io
import re
import shlex
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from ruamel.yaml import YAML

import conveyor
import conveyor.spec
from conveyor.results.analysis import analyse_studies
from conveyor.starter.format_reference import heading_anchor
from conveyor.starter.starter_data import starter_values
from tests.command_line import run

ROOT = Path(__file__).parent.parent
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")), ROOT / "materials" / "README.md"]
REFUSED = "S100_strain_sweep.txt"  # the page shows what a doubtful file ends in
OTHER_PROGRAMS = ("make ", "py -m venv ", ".venv\\Scripts\\python -m pip ")
WRITTEN = re.compile(r"(?:-o|--plot|--tables|--plots|--from|conveyor new|template) (\S+\.\w+|\S+)")
# forces hold to the contact's rtol of 1e-6; a printed digit may round either way
RELATIVE = 2e-6


class Block(NamedTuple):
    """A fenced block: language and text."""

    language: str
    text: str


def blocks(page: Path) -> list[Block]:
    found = re.findall(r"^```(\w+)\n(.*?)^```$", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.M)
    return [Block(*block) for block in found]


def pages_with(*languages: str) -> list[Path]:
    return [page for page in PAGES if any(block.language in languages for block in blocks(page))]


def named(page: Path) -> str:
    return "materials" if page.parent.name == "materials" else page.stem


@pytest.fixture(scope="module")
def folder_of_pages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder that looks like a checkout, in which a reader follows one page after the other."""
    there = tmp_path_factory.mktemp("checkout")
    for folder in ("examples", "materials", "tests"):
        (there / folder).symlink_to(ROOT / folder)
    return there


@pytest.fixture
def checkout(folder_of_pages: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of all pages, as the current one."""
    monkeypatch.chdir(folder_of_pages)
    return folder_of_pages


def same(printed: str, expected: str) -> None:
    number = r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
    got, told = ([float(text) for text in re.findall(number, part)] for part in (printed, expected))
    for a, b, text in zip(got, told, re.findall(number, expected), strict=True):
        last = 10.0 ** -len(text.partition("e")[0].partition(".")[2])
        assert a == pytest.approx(b, rel=RELATIVE, abs=last * 1.000001 if "." in text else 0.0)
    words = re.compile(rf"(?:{number}|\s)+")
    assert words.sub(" ", printed) == words.sub(" ", expected)


def words(text: str) -> str:
    return " ".join(text.split())


@pytest.mark.parametrize("page", pages_with("sh", "powershell"), ids=named)
def test_commands_of_a_page(page: Path, checkout: Path) -> None:
    printed = ""
    for block in blocks(page):
        if block.language == "text" and printed:
            # columns are as wide as this version of rich makes them
            assert all(words(line) in words(printed) for line in block.text.splitlines()), block.text
        if block.language not in {"sh", "powershell"}:
            printed = printed if block.language in {"text", "yaml"} else ""
            continue
        printed = ""
        for line in filter(None, block.text.splitlines()):
            command = line.split("  #", maxsplit=1)[0].split(" # ", maxsplit=1)[0].strip()
            command = command.replace(".venv\\Scripts\\conveyor ", "conveyor ")
            if not command.startswith("conveyor "):
                assert command.startswith(OTHER_PROGRAMS), command
                continue
            code, out, err = run(*shlex.split(command)[1:], cwd=checkout, columns=80)
            printed += out
            assert code == (2 if REFUSED in command else 0), f"{command}: {err}"
            if REFUSED in command:
                assert "--modulus-unit" in err
                assert "--strain-unit" in err
                continue
            for name in WRITTEN.findall(command):
                assert (checkout / name).is_dir() or (checkout / name).stat().st_size > 100, name


@pytest.mark.parametrize("page", pages_with("python"), ids=named)
def test_code_of_a_page(page: Path, checkout: Path) -> None:
    from matplotlib import pyplot as plt

    space: dict[str, Any] = {}
    found = blocks(page)
    for block, after in zip(found, [*found[1:], Block("", "")], strict=True):
        if block.language != "python":
            continue
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            exec(compile(block.text, page.name, "exec"), space)
        same(out.getvalue(), after.text if after.language == "text" else "")
    plt.close("all")
    assert any(checkout.iterdir())


def overland() -> dict[str, Any]:
    path = ROOT / "examples" / "specs" / "overland.yaml"
    read: dict[str, Any] = YAML(typ="safe").load(path.read_text(encoding="utf-8"))
    return read


def merged(base: Any, other: Any) -> Any:
    if isinstance(base, dict) and isinstance(other, dict):
        return base | {key: merged(base.get(key), value) for key, value in other.items()}
    return other


FRAGMENTS = [(page, i) for page in PAGES for i, b in enumerate(blocks(page)) if b.language == "yaml"]


@pytest.mark.parametrize(("page", "number"), FRAGMENTS, ids=lambda x: named(x) if isinstance(x, Path) else str(x))
def test_fragment_of_a_spec(page: Path, number: int) -> None:
    """A whole spec runs as it stands, a fragment merged into the overland example."""
    fragment = YAML(typ="safe").load(blocks(page)[number].text)
    line = conveyor.spec.from_data(fragment if "name" in fragment else merged(overland(), fragment))
    found = conveyor.analyse(line)
    assert found.balance.power.motor > 0.0
    analyse_studies(line, found)


def test_the_studies_on_their_page_are_the_examples() -> None:
    page = (ROOT / "docs" / "studies.md").read_text(encoding="utf-8")
    shown = [part.split("```")[0] for part in page.split("```yaml study\n")[1:]]
    files = [ROOT / "examples" / "studies" / f"{name}.yaml" for name in ("spacing", "year", "search")]
    assert shown == [file.read_text(encoding="utf-8").partition("\n")[2] for file in files]


def test_defaults_on_the_designers_page_do_what_it_says() -> None:
    text = (ROOT / "docs" / "designer.md").read_text(encoding="utf-8")
    given = starter_values("overland")

    def motor(change: dict[str, Any]) -> str:
        line = conveyor.spec.from_data(merged(given, change))
        return f"{conveyor.analyse(line).balance.power.motor / 1e3:.0f}"

    assert f"motor {motor({})} kW)" in text
    drags = [
        motor({"idlers": {s: {"roll": {"drag": d}} for s in ("carry", "return")}}) for d in ("1 N", "1.6 N", "4 N")
    ]
    assert f"| 1 / 1.6 / 4 N | {' / '.join(drags)} kW |" in text
    shares = [motor({"calculation": {"flexure_share": share}}) for share in ("5 %", "20 %")]
    assert f"| 5 / 20 % | {' / '.join(shares)} kW |" in text
    powers = [
        conveyor.analyse(
            conveyor.spec.from_data(merged(overland(), {"belt": {"bottom_cover": {"compound": name}}}))
        ).balance.power.motor
        for name in ("low-rolling-resistance-cover", "standard-cover")
    ]
    assert f"| + {powers[1] / powers[0] - 1.0:.0%} on the overland example |".replace("%", " %") in text


def test_pages_have_their_blocks() -> None:
    assert {named(page) for page in pages_with("sh")} >= {"README", "designer", "rubber"}
    assert {named(page) for page in pages_with("python")} >= {"README", "programmer"}
    assert {named(page) for page, _ in FRAGMENTS} >= {"conveyor", "designer", "spec"}
    readme = blocks(ROOT / "README.md")
    python = next(block for block in readme if block.language == "python")
    assert len([line for line in python.text.splitlines() if line]) <= 15


def test_every_language_is_run() -> None:
    known = {"sh", "powershell", "python", "yaml", "text", "console"}
    assert {block.language for page in PAGES for block in blocks(page)} <= known


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_links_pictures_and_anchors_exist(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    for target, place in re.findall(r"\]\(([^)#\s]*)(?:#([^)]*))?\)", text):
        if target.startswith(("http://", "https://")):
            continue
        path = page.parent / target if target else page
        assert path.exists(), f"{page.name}: {target}"
        if place:
            lines = path.read_text(encoding="utf-8").splitlines()
            headings = {heading_anchor(line.lstrip("#").strip()) for line in lines if line.startswith("#")}
            assert place in headings, f"{page.name}: {target}#{place}"


def test_make_does_what_the_readme_says() -> None:
    made = (ROOT / "Makefile").read_text(encoding="utf-8")
    assert "\nreport:" in made
    assert "conveyor power examples/specs/overland.yaml -o $(OUT)/overland.xlsx" in made
    assert "\ntest:" in made


def test_every_page_is_in_the_index() -> None:
    index = (ROOT / "docs" / "README.md").read_text(encoding="utf-8")
    for page in (ROOT / "docs").glob("*.md"):
        assert page.name == "README.md" or f"]({page.name})" in index


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_tables_are_whole(page: Path) -> None:
    """A blank line in a table, or a row with another number of cells, breaks it where it is rendered."""
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    for table in re.findall(r"^\|.*(?:\n\|.*)*", text, re.MULTILINE):
        rows = table.splitlines()
        assert len(rows) > 1, rows[0]
        assert re.fullmatch(r"\|[-:| ]+\|", rows[1]), rows[0]
        assert len({len(re.findall(r"(?<!\\)\|", row)) for row in rows}) == 1, table
