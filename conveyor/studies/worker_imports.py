"""Imports and model builds for worker start-up: once, if workers are forked from one process."""

from __future__ import annotations

import conveyor.studies.points  # noqa: F401
from conveyor.models import Conveyor, RubberCompound

for _model in (RubberCompound, Conveyor):
    _model.model_rebuild()  # else each process builds it as it reads its first job
