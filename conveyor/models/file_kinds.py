"""Files of the wrong kind: a duty, study, search, spec or compound given where another of them is read."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final, TypeVar

from pydantic import BaseModel

from conveyor.errors import InputError
from conveyor.files.document import read_document
from conveyor.models.compound import RubberCompound
from conveyor.models.conveyor import Conveyor
from conveyor.models.model_file import read_model
from conveyor.models.sizing import SizingDuty
from conveyor.models.study import SearchPlan, StudyPlan

M = TypeVar("M", bound=BaseModel)

_KINDS: Final[dict[type[BaseModel], tuple[str, str]]] = {
    Conveyor: ("the spec of a conveyor", "conveyor power {}"),
    SizingDuty: ("a duty to size a conveyor from", "conveyor size {}"),
    StudyPlan: ("a study", "conveyor study {} -o points.csv"),
    SearchPlan: ("a search for the best design", "conveyor optimise {} -o best.yaml"),
    RubberCompound: ("a rubber compound", 'a spec, as "compound: {}" of a cover'),
}
"""Noun of each kind of file, and what reads it."""


def read_file_of(model: type[M], path: Path, context: Mapping[str, Any] | None = None) -> M:
    """Read a model from a file as `read_model`; of a file of another kind the error says what reads it.

    Raises
    ------
    InputError
        As `read_model`, or the file is of another kind.
    """
    try:
        return read_model(model, path, context)
    except InputError:
        other = _likeliest_kind(path, model)
        if other is model:
            raise
        noun, reader = _KINDS[other]
        message = f"{path}: is {noun}, expected {_KINDS[model][0]}; it is read by {reader.format(path)}"
        raise InputError(message) from None


def _likeliest_kind(path: Path, wanted: type[BaseModel]) -> type[BaseModel]:
    """Kind with most of a file's keys; the wanted one where none has more."""
    try:
        keys = set(map(str, read_document(path).data))
    except InputError:
        return wanted

    def known(kind: type[BaseModel]) -> int:
        return len(keys & {field.alias or name for name, field in kind.model_fields.items()})

    return max((wanted, *_KINDS), key=known)
