"""The shelf: built-in compounds, user folders, names in any case, what is refused."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from conveyor import shelf
from conveyor.errors import InputError
from conveyor.files import compound_folders as shelf_files
from conveyor.units import si

BUILT_IN = ["cold-resistant-cover", "low-rolling-resistance-cover", "s100", "s120", "standard-cover"]


@pytest.fixture(autouse=True)
def _no_user_shelf(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(shelf.ENVIRONMENT, raising=False)


def user_file(folder: Path, name: str, title: str = "mine") -> Path:
    data = shelf.compound("standard-cover").as_data() | {"name": title}
    path = folder / name
    path.write_text(json.dumps(data), encoding="utf-8")
    return path


def test_built_in_names() -> None:
    assert set(BUILT_IN) <= set(shelf.names())


@pytest.mark.parametrize("name", BUILT_IN)
def test_built_in_compound_is_what_its_name_says(name: str) -> None:
    compound = shelf.compound(name)
    assert compound.name.casefold() == name
    assert shelf.compound(name.upper()) == compound
    assert compound.range is not None
    low, high = (si(t) for t in compound.range.temperature)
    assert low < 273.15
    assert high > 293.15
    # The stated range is covered by the shift, end to end.
    for temperature in (low, 293.15, high):
        assert compound.series(temperature).equilibrium > 0


def test_every_built_in_says_what_it_is() -> None:
    kinds = {name: shelf.compound(name).kind for name in BUILT_IN}
    assert {name for name, kind in kinds.items() if kind == "measured"} == {"s100", "s120"}
    for name in BUILT_IN:
        compound = shelf.compound(name)
        assert compound.missing
        assert compound.source.licence


def test_unknown_name_lists_the_shelf() -> None:
    with pytest.raises(
        InputError, match=r'unknown compound "S110"; did you mean "s1[02]0"\?; on the shelf: .*cover, s100'
    ):
        shelf.compound("S110")


def test_path_relative_to_base(tmp_path: Path) -> None:
    path = user_file(tmp_path, "mine.json")
    assert shelf.compound("mine.json", base=tmp_path).name == "mine"
    assert shelf.compound(path).name == "mine"
    assert shelf.compound("./mine.json", base=tmp_path) == shelf.compound(str(path))
    with pytest.raises(InputError, match=r"other.yaml: no such file"):
        shelf.compound("other.yaml", base=tmp_path)


def test_user_folders_by_argument_and_environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    user_file(tmp_path, "Mine.json")
    with pytest.raises(InputError, match='unknown compound "mine"'):
        shelf.compound("mine")
    assert shelf.compound("mine", extra=[tmp_path]).name == "mine"
    assert "mine" in shelf.names([tmp_path])
    monkeypatch.setenv(shelf.ENVIRONMENT, str(tmp_path))
    assert shelf.compound("MINE").name == "mine"
    # The same folder twice is one folder.
    assert shelf.compound("mine", extra=[tmp_path]).name == "mine"


def test_name_on_two_shelves_is_refused(tmp_path: Path) -> None:
    user_file(tmp_path, "s100.json")
    with pytest.raises(InputError, match=r'"S100" is on the shelf twice: .*s100.json and .*s100.yaml'):
        shelf.compound("S100", extra=[tmp_path])


def test_missing_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nowhere: no such folder .*CONVEYOR_SHELF"):
        shelf.names([tmp_path / "nowhere"])


def test_changed_file_is_read_again(tmp_path: Path) -> None:
    path = user_file(tmp_path, "mine.json", "first")
    assert shelf.compound(path).name == "first"
    assert shelf.compound(path) is shelf.compound(path)
    user_file(tmp_path, "mine.json", "second title")
    assert shelf.compound(path).name == "second title"


def test_file_with_errors_lists_all_with_places(tmp_path: Path) -> None:
    path = tmp_path / "bad.yaml"
    path.write_text("name: bad\nname: twice\nkind: measured\npoisson_ratio: half\n", encoding="utf-8")
    with pytest.raises(InputError) as caught:
        shelf.compound(path)
    lines = str(caught.value).splitlines()
    assert f"{path}:2:1 name: given twice, first in line 1; remove one" in lines
    assert f'{path}:4:16 poisson_ratio: expected a number, got "half"' in lines
    assert f"{path}:1:1 prony: missing; expected fields: equilibrium, terms" in lines


def test_packaged_shelf_is_found_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "conveyor"
    package.mkdir()
    monkeypatch.setattr(shelf_files, "__file__", str(package / "files" / "shelves.py"))
    with pytest.raises(InputError, match="no built-in shelf in"):
        shelf.built_in()
    (tmp_path / "materials").mkdir()
    assert shelf.built_in() == tmp_path / "materials"
    (package / "_materials").mkdir()
    assert shelf.built_in() == package / "_materials"
    source = Path(__file__).parent.parent / "materials" / "s100.yaml"
    shutil.copy(source, package / "_materials")
    assert shelf.names() == ["s100"]
