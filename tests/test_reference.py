"""The reference of the file formats: complete, with examples that their fields accept, and docs/spec.md is it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated, Any, Union, get_args, get_origin

import pytest
from pydantic import BaseModel, TypeAdapter
from typer.testing import CliRunner

from conveyor.cli import app
from conveyor.models import Conveyor, RubberCompound
from conveyor.models.sizing import SizingDuty
from conveyor.starter.format_reference import example_value, format_fields, heading_anchor, markdown_reference

PAGE = Path(__file__).parent.parent / "docs" / "spec.md"
FORMATS = (Conveyor, SizingDuty, RubberCompound)
FIELDS = [(model, path) for model in FORMATS for path in format_fields(model)]


def models_in(annotation: Any) -> list[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [model for arg in get_args(annotation) for model in models_in(arg)]


def annotations(model: type[BaseModel], path: str) -> list[Any]:
    """Types that a field may have: one, or one for each variant of a block."""
    head, _, rest = path.replace("[]", "").partition(".")
    infos = [info for name, info in model.model_fields.items() if head == (info.alias or name)]
    if not rest:
        return [Annotated[(i.annotation, *i.metadata)] if i.metadata else i.annotation for i in infos]
    inner = [m for info in infos for m in models_in(info.annotation)]
    return [found for m in inner for found in annotations(m, rest)]


@pytest.mark.parametrize(("model", "path"), FIELDS)
def test_every_example_is_accepted(model: type[BaseModel], path: str) -> None:
    leaf = format_fields(model)[path]
    if leaf.kind == "reference" or (model, path) == (SizingDuty, "covers"):
        return
    shown = example_value(model, path)
    assert shown not in (None, ""), f"{path}: give an example in conveyor/_reference/examples.yaml"
    types = annotations(model, path)
    assert types
    TypeAdapter(types[0] if len(types) == 1 else Union[tuple(types)]).validate_python(  # noqa: UP007
        tuple(shown) if get_origin(types[0]) is tuple and isinstance(shown, list) else shown
    )


@pytest.mark.parametrize(("model", "path"), FIELDS)
def test_every_field_says_what_it_is(model: type[BaseModel], path: str) -> None:
    assert format_fields(model)[path].doc


def test_an_example_outside_its_field_would_be_seen() -> None:
    (kind,) = annotations(Conveyor, "route.sections[].length")
    with pytest.raises(ValueError, match="allowed"):
        TypeAdapter(kind).validate_python("-1 m")


def test_page_is_what_the_models_say() -> None:
    assert PAGE.read_text(encoding="utf-8") == markdown_reference(), "run: conveyor schema --markdown > docs/spec.md"


def test_command_line_prints_the_page() -> None:
    found = CliRunner().invoke(app, ["schema", "--markdown"])
    assert found.exit_code == 0
    assert found.stdout == markdown_reference()


def test_every_field_is_on_the_page() -> None:
    text = markdown_reference()
    blocks = re.split(r"\n## The (?:duty|compound)\n", text)
    elsewhere = format_fields(Conveyor)
    for model, block in zip(FORMATS, blocks, strict=True):
        own = [path for path, leaf in format_fields(model).items() if model is Conveyor or elsewhere.get(path) != leaf]
        keys = {path.split(".")[-1] for path in own}
        assert {key for key in keys if f"| `{key}` |" not in block} == set()


def test_every_link_has_its_heading_and_every_heading_is_once() -> None:
    text = markdown_reference()
    headings = [heading_anchor(line.lstrip("#").strip()) for line in text.splitlines() if line.startswith("#")]
    assert len(headings) == len(set(headings))
    assert set(re.findall(r"\]\(#([^)]+)\)", text)) <= set(headings)


def test_rows_have_five_cells() -> None:
    for line in markdown_reference().splitlines():
        if line.startswith("| `") and "** |" in line:
            assert len(re.split(r"(?<!\\)\|", line)) == 7
