"""Study files: what varies of which spec; every error with file, line and column."""

from __future__ import annotations

from pathlib import Path

from pydantic import ValidationError

from conveyor.errors import InputError
from conveyor.explain import findings
from conveyor.files.document import listing, read_document
from conveyor.models.study import StudyPlan


def read_plan(path: str | Path) -> StudyPlan:
    """Read a study from a ``.yaml``, ``.yml`` or ``.json`` file.

    Raises
    ------
    InputError
        The file cannot be read, or is refused; all its errors at once, each with file, line, column and field.
    """
    document = read_document(Path(path))
    found = list(document.findings)
    plan = None
    try:
        plan = StudyPlan.model_validate(document.data)
    except ValidationError as error:
        found = findings(error, StudyPlan, document)
    if plan is None or found:
        raise InputError(listing(document.path, found))
    return plan
