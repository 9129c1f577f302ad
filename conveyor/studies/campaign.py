"""A study run: its points in batches on any executor, every answer kept as it comes, so that a stopped run goes on.

Answers stand in a file of lines, each with the key of its point: a hash of all that it follows from (spec, compounds,
changes, figures asked for, version). What is there already is not calculated again; a line that was half written when
a run ended is seen and dropped. The table is written from the file, in the order of the points, whatever order their
answers came in.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from dataclasses import dataclass
from functools import cached_property
from importlib.metadata import version
from itertools import islice
from pathlib import Path
from typing import IO, Final, Self, TypeAlias

from conveyor.errors import ConveyorError, InputError
from conveyor.models import Conveyor, RubberCompound
from conveyor.models.fields import field as field_of
from conveyor.models.study import Changes, StudyPlan, Value
from conveyor.spec import fingerprint
from conveyor.studies.points import Answer, answers, outputs_of

BATCH: Final = 64
"""Points solved side by side, and lost at most where a run is stopped."""
AHEAD: Final = 2
"""Batches a worker that are handed out at once."""

_KEY: Final = slice(2, 34)  # of a line
_ANSWERED: Final = re.compile(rb'\["[0-9a-f]{32}", .*\]\n')
_BEGUN: Final = re.compile(rb'\[("[0-9a-f]{0,32}|"[0-9a-f]{32}".*)?')

Progress = Callable[[int, int], None]
Point: TypeAlias = tuple[int, tuple[Value, ...], Answer]
"""Number of a point, its values of `plan.paths`, its answer."""


@dataclass(frozen=True, eq=False)
class Campaign:
    """A study with its spec and compounds read.

    Attributes
    ----------
    plan : StudyPlan
        What varies.
    base : Conveyor
        The spec.
    compounds : mapping
        Those that points name.
    outputs : tuple of str
        Keys of the figures asked for.
    """

    plan: StudyPlan
    base: Conveyor
    compounds: Mapping[str, RubberCompound]
    outputs: tuple[str, ...]

    @classmethod
    def of(cls, plan: StudyPlan, base: Conveyor, resolve: Callable[[str], RubberCompound]) -> Self:
        """Read what a plan names.

        Raises
        ------
        InputError
            A compound, a figure or a field is not known.
        """
        columns = {path: field_of(base, path) for path in plan.paths}
        rubber = [path for path, value in columns.items() if isinstance(value, RubberCompound)]
        given = {
            path: plan.axes.get(path, tuple(row[path] for row in plan.together if path in row))
            for path in rubber
        }
        named = {value for values in given.values() for value in values if isinstance(value, str)}
        return cls(
            plan, base, {name: resolve(name) for name in sorted(named)}, tuple(outputs_of(plan.outputs))
        )

    @cached_property
    def _common(self) -> hashlib._Hash:
        """Hash of what every point follows from."""
        rubber = {name: one.as_data() for name, one in self.compounds.items()}
        told = [version("conveyor"), fingerprint(self.base), self.outputs, rubber]
        return hashlib.sha256(json.dumps(told, sort_keys=True).encode())

    def key(self, point: Changes) -> str:
        """Hash of all that the answer of a point follows from."""
        found = self._common.copy()
        found.update(json.dumps(point, sort_keys=True).encode())
        return found.hexdigest()[:32]


class Answers:
    """A file of answers by key that only grows; what was half written is dropped when it is opened.

    Raises
    ------
    InputError
        The file holds something else.
    """

    def __init__(self, path: Path) -> None:
        self._at: dict[str, int] = {}
        self._file: IO[bytes] = path.open("a+b")
        self._file.seek(0)
        end = 0
        for line in self._file:
            whole = line.endswith(b"\n")
            if not (_ANSWERED if whole else _BEGUN).fullmatch(line):
                self._file.close()
                raise InputError(f"{path}: holds something else than answers of a study; remove it")
            if whole:
                self._at[line[_KEY].decode()] = end
                end += len(line)
        self._file.truncate(end)

    def __contains__(self, key: str) -> bool:
        return key in self._at

    def __getitem__(self, key: str) -> Answer:
        self._file.seek(self._at[key])
        found: Answer = json.loads(self._file.readline())[1]
        return found

    def add(self, found: Iterable[tuple[str, Answer]]) -> None:
        """Keep answers, on the disk when this returns."""
        self._file.seek(0, os.SEEK_END)
        end, lines = self._file.tell(), []
        for key, answer in found:
            lines.append(json.dumps([key, answer]).encode() + b"\n")
            self._at[key] = end
            end += len(lines[-1])
        self._file.write(b"".join(lines))
        self._file.flush()
        os.fsync(self._file.fileno())

    def __len__(self) -> int:
        return len(self._at)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()


def run(
    campaign: Campaign,
    known: Answers,
    *,
    executor: Executor | None = None,
    workers: int = 1,
    progress: Progress | None = None,
) -> None:
    """Calculate every point whose answer is not known.

    Parameters
    ----------
    campaign : Campaign
        The study.
    known : Answers
        What is known; new answers are added batch by batch.
    executor : concurrent.futures.Executor, optional
        Where batches are calculated: processes, a cluster; in this process without one.
    workers : int
        Of the executor: as many batches are handed out at once, and as many again.
    progress : callable, optional
        Called with points that have an answer, and all.

    Raises
    ------
    ConveyorError
        A worker was lost; what is done is kept, the same call goes on from there.
    """
    done = sum(campaign.key(point) in known for point in campaign.plan.points())
    asked: dict[Future[list[Answer]], list[str]] = {}
    new, most = _batches(campaign, known), 1 if executor is None else AHEAD * workers
    try:
        while True:
            for keys, points in islice(new, most - len(asked)):
                task = (campaign.base, points, campaign.outputs, campaign.compounds)
                asked[_here(task) if executor is None else executor.submit(answers, *task)] = keys
            if progress is not None:
                progress(done, campaign.plan.count)
            if not asked:
                return
            for future in wait(asked, return_when=FIRST_COMPLETED).done:
                keys = asked.pop(future)
                known.add(zip(keys, future.result(), strict=True))
                done += len(keys)
    except BrokenExecutor:
        raise ConveyorError(
            "a worker of the study was lost (out of memory, or stopped); what is done is kept: run it again to go on"
        ) from None
    finally:
        for future in asked:
            future.cancel()


def _here(
    task: tuple[Conveyor, list[Changes], tuple[str, ...], Mapping[str, RubberCompound]],
) -> Future[list[Answer]]:
    """The answers of a batch, calculated in this process."""
    future: Future[list[Answer]] = Future()
    future.set_result(answers(*task))
    return future


def _batches(campaign: Campaign, known: Answers) -> Iterator[tuple[list[str], list[Changes]]]:
    """Points without an answer and their keys, `BATCH` at a time."""
    new = {}
    for point in campaign.plan.points():
        key = campaign.key(point)
        if key not in known:
            new[key] = point
        if len(new) == BATCH:
            yield list(new), list(new.values())
            new = {}
    if new:
        yield list(new), list(new.values())


def rows(campaign: Campaign, known: Answers) -> Iterator[Point]:
    """Every point, in the order of the plan."""
    for number, point in enumerate(campaign.plan.points(), start=1):
        yield number, tuple(point[path] for path in campaign.plan.paths), known[campaign.key(point)]
