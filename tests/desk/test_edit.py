"""Values replaced between their marks: what is not changed stays byte for byte."""

from __future__ import annotations

import difflib
from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from ruamel.yaml import YAML

import conveyor
from conveyor.errors import InputError
from conveyor.files.edit import edit_values

SPECS = sorted(Path("examples/specs").glob("*.yaml"))


def lines_of_diff(before: str, after: str) -> list[str]:
    made = difflib.unified_diff(before.splitlines(), after.splitlines(), n=0, lineterm="")
    return [line for line in made if line[:1] in "+-" and line[:3] not in {"+++", "---"}]


@pytest.mark.parametrize("spec", SPECS, ids=lambda path: path.stem)
def test_two_changes_are_two_lines_of_diff_and_comments_stay(spec):
    before = spec.read_text(encoding="utf-8")
    changes = {"belt.speed": "4.4 m/s", "material.flow": "777 t/h"}
    after = edit_values(before, changes, spec)
    assert len(lines_of_diff(before, after)) == 4  # two out, two in
    assert [line.partition("#")[2] for line in before.splitlines()] == [
        line.partition("#")[2] for line in after.splitlines()
    ]


def test_the_edited_file_is_the_changed_conveyor(tmp_path):
    spec = Path("examples/specs/overland.yaml")
    changes = {"route.sections.bridge.lift": "1 m", "operation.price": "0.2 EUR/kWh", "drive.efficiency": "95 %"}
    saved = tmp_path / "edited.yaml"
    saved.write_text(edit_values(spec.read_text(encoding="utf-8"), changes, spec), encoding="utf-8")
    from conveyor.models.fields import with_fields

    assert conveyor.load(saved) == with_fields(conveyor.load(spec), changes)


@pytest.mark.parametrize(
    ("before", "changes", "after"),
    [
        ("a: 1 # one\n", {"a": 2}, "a: 2 # one\n"),
        ("a: 5 m/s     # one\n", {"a": "5.55 m/s"}, "a: 5.55 m/s  # one\n"),
        ("a: 5.55 m/s  # one\n", {"a": "5 m/s"}, "a: 5 m/s     # one\n"),
        ("a: 1", {"b.c": "3 m"}, "a: 1\nb:\n  c: 3 m\n"),
        ("a: {x: 1 m} # k\n", {"a.y": "2 m"}, "a: {x: 1 m, y: 2 m} # k\n"),
        ("a: {x: 1,}\n", {"a.y": 2}, "a: {x: 1, y: 2,}\n"),
        ("a: {}\n", {"a.y": 2}, "a: {y: 2}\n"),
        ("a:\nb: 1\n", {"a.y": 2}, "a: {y: 2}\nb: 1\n"),
        ("a:   # later\nb: 1\n", {"a": "now"}, "a: now   # later\nb: 1\n"),
        ("a: null\n", {"a.y": True}, "a: {y: true}\n"),
        ("a: 'it'\n", {"a": "it's"}, "a: 'it''s'\n"),
        ('a: "x"\n', {"a": "5 m"}, 'a: "5 m"\n'),
        ("a: x\n", {"a": "true"}, 'a: "true"\n'),
        ("a: x\n", {"a": "5"}, 'a: "5"\n'),
        ("a: x\n", {"a": "k: v # no"}, 'a: "k: v # no"\n'),
        ("a: |\n  x\n  y\nb: 1\n", {"a": "z"}, "a: z\nb: 1\n"),
        ("a:\n  - 1\n  - 2\nb: 1\n", {"a": [3]}, "a:\n  [3]\nb: 1\n"),
        ("a:\r\n  b: 1 # x\r\n", {"a.b": 2, "a.c": 3}, "a:\r\n  b: 2 # x\r\n  c: 3\r\n"),
        ("\ufeffa: 1\n", {"a": 2}, "\ufeffa: 2\n"),
        ("l:\n- name: p\n  v: 1\n- {name: q}\n", {"l.q.v": 2}, "l:\n- name: p\n  v: 1\n- {name: q, v: 2}\n"),
        ("l:\n- name: p\n  v: 1\n- {name: q}\n", {"l[0].w": 3}, "l:\n- name: p\n  v: 1\n  w: 3\n- {name: q}\n"),
        ("a: 5 m\n", {"a": None}, "a: null\n"),
    ],
)  # fmt: skip
def test_places_of_values(before, changes, after):
    assert edit_values(before, changes, Path("spec.yaml")) == after


def test_json_stays_json():
    before = '{"a": {"b": "1 m"},\n\t"c": []}\n'
    after = edit_values(before, {"a.b": "2 m", "d.e": 1.5}, Path("spec.json"))
    assert after == '{"a": {"b": "2 m"},\n\t"c": [], "d": {"e": 1.5}}\n'


@pytest.mark.parametrize(
    ("before", "path", "message"),
    [
        ("a: &x {b: 1}\nc: *x\n", "c.b", "shared by the anchor &x"),
        ("a: 1\n", "a.b", "single value at a"),
        ("a: [1]\n", "a[3]", "no item 3"),
        ("a: 1\n", "b[0].c", "no such list"),
        ("a: [\n", "a", "syntax"),
    ],
)
def test_what_cannot_be_changed_in_place_is_refused(before, path, message):
    with pytest.raises(InputError, match=message):
        edit_values(before, {path: 2}, Path("spec.yaml"))


@given(st.text(st.characters(exclude_categories=["Cs", "Cc"], exclude_characters="\u2028\u2029\ufeff"), max_size=30))
@example("01")
@example("1_000")
@example("2020-01-01")
def test_every_text_is_read_back(text):
    after = edit_values("a: x  # y\nb: {c: z}\n", {"a": text, "b.c": text}, Path("spec.yaml"))
    assert YAML(typ="safe", pure=True).load(after) == {"a": text, "b": {"c": text}}
