"""What processes that calculate batches read and build before their first one: once, where they are copies of one."""

from __future__ import annotations

import conveyor.pint_alone
import conveyor.studies.points  # noqa: F401
from conveyor.models import Conveyor, RubberCompound

for _model in (RubberCompound, Conveyor):
    _model.model_rebuild()  # else each process builds it as it reads its first job
