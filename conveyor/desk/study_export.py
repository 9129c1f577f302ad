"""A study file of the variants on the desk: each a row of fields that go together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from conveyor.desk.design_form import DesignField, read_change
from conveyor.desk.design_variant import TextChanges
from conveyor.desk.workbench import OpenFile
from conveyor.errors import InputError
from conveyor.files.document import yaml_text


def study_text(of: OpenFile, rows: Sequence[DesignField], variants: Sequence[TextChanges]) -> str:
    """Study file (YAML) of a spec as it is and of its variants, for `conveyor study`.

    Parameters
    ----------
    of : OpenFile
        The file that the variants change.
    rows : sequence of DesignField
        Its fields.
    variants : sequence of mapping
        Changes of each variant.

    Raises
    ------
    InputError
        No variant changes a field, or one changes a field that the spec does not give.
    """
    paths = list(dict.fromkeys(path for changes in variants for path in changes))
    if not paths:
        raise InputError("nothing is changed: a study needs a variant that differs from its spec")
    values = {row.path: row.value for row in rows}
    missing = [path for path in paths if values.get(path) is None]
    if missing:
        raise InputError(f"{missing[0]}: the spec does not give it; save the spec with it, then export the study")
    together: list[dict[str, Any]] = []
    for changes in ({}, *variants):
        made = {path: read_change(path, changes.get(path, values[path])) for path in paths}
        if made not in together:
            together.append(made)
    plan = {"name": f"Variants of {of.conveyor.name}"[:100], "base": of.saved_name, "together": together}
    return "# Variants of the desk; beside its base: conveyor study THIS -o points.csv\n" + yaml_text(plan, width=110)
