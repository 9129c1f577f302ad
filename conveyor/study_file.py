"""Files of studies and of duties to size; every error with file, line and column."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ValidationError

from conveyor import shelf
from conveyor.errors import InputError
from conveyor.explain import findings
from conveyor.files.document import listing, read_document
from conveyor.models.base import Model
from conveyor.models.sizing import SizingDuty
from conveyor.models.study import StudyPlan

M = TypeVar("M", bound=Model)


def read_plan(path: str | Path) -> StudyPlan:
    """Read a study from a ``.yaml``, ``.yml`` or ``.json`` file.

    Raises
    ------
    InputError
        The file cannot be read, or is refused; all its errors at once, each with file, line, column and field.
    """
    return _read(StudyPlan, Path(path))


def read_duty(path: str | Path, *, shelves: Iterable[str | Path] = ()) -> SizingDuty:
    """Read the duty of a conveyor that is to be sized; as `read_plan`, compounds by name or path.

    Raises
    ------
    InputError
        As `read_plan`.
    """
    where = Path(path)
    return _read(SizingDuty, where, {"compound": shelf.resolver(extra=shelves, base=where.parent)})


def _read(model: type[M], path: Path, context: dict[str, Any] | None = None) -> M:
    """A model from a file."""
    document = read_document(path)
    found = list(document.findings)
    read = None
    try:
        read = model.model_validate(document.data, context=context)
    except ValidationError as error:
        found = findings(error, model, document)
    if read is None or found:
        raise InputError(listing(document.path, found))
    return read
