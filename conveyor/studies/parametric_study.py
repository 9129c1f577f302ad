"""A parametric study: points in batches on any executor, every answer saved as it comes, so that a run can resume.

Answers are stored in a SQLite file (unfinished writes are rolled back), each under the key of its point: a hash of all
that it depends on (spec, compounds, changes, requested figures, version). Stored answers are not calculated again and
not held in memory. The table is written from the file in the order of the points, whatever order the answers came in.
"""

from __future__ import annotations

import hashlib
import json
import math
import sqlite3
import warnings
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache, cached_property
from importlib.metadata import version
from itertools import islice
from pathlib import Path
from typing import Final, NamedTuple, Self, TypeAlias

from conveyor.arguments.limits import require_workers
from conveyor.errors import ConveyorError, InputError, ValidityWarning
from conveyor.models import Conveyor, RubberCompound
from conveyor.models.fields import field_value as field_of
from conveyor.models.fields import with_fields
from conveyor.models.operation import Operation
from conveyor.models.study import Changes, StudyPlan, Value, VariedSpec, with_states
from conveyor.spec import fingerprint
from conveyor.studies.costs import missing_price_fields
from conveyor.studies.design_figures import Design, DesignFigure, figures_by_name, reduce_states, require_year
from conveyor.studies.plan_checks import refuse_unknown
from conveyor.studies.points import (
    OUTPUTS,
    Answer,
    Job,
    all_loads_keys,
    evaluate_points,
    price_answer,
    required_outputs,
    select_outputs,
)
from conveyor.studies.worker_failures import report_lost_worker

BATCH_SIZE: Final = 256
"""Most points solved in one batch, and lost when a run is stopped."""
LEAST_BATCHES: Final = 16
"""Batches of a smaller study at least, so that several workers have work."""
SMALLEST_BATCH: Final = 8
"""Fewest points of such a batch."""
BATCHES_AHEAD: Final = 2
"""Batches per worker submitted at once."""
WINDOW: Final = 16 * BATCH_SIZE
"""Points searched for those that share rubber, temperature and speed."""
_BOTH_STRAND_FIELDS: Final = ("ambient.", "belt.speed", "belt.top_cover.")
"""Fields that affect the rolls of both strands: points that differ only in others may share the return rolls."""

_MARK: Final = 0x636F6E77
"""SQLite application id of a file of answers with checksums."""
_COLUMNS: Final = "(key BLOB PRIMARY KEY, answer BLOB, checksum INTEGER) WITHOUT ROWID"

PointProgress: TypeAlias = Callable[[int, int, int], None]
"""Called with the points done, their total, and the number without an answer in this run."""
Point: TypeAlias = tuple[int, tuple[Value, ...], Answer]
"""Number of a point, its values of `plan.paths`, its answer."""
KeyedPoint: TypeAlias = tuple[bytes, Changes]
"""A point with the key of its answer."""
BatchCallback: TypeAlias = Callable[[Sequence[tuple[int, KeyedPoint]]], None]
"""Called with a batch of answered points, by their numbers from 1."""


@dataclass(frozen=True, eq=False)
class ParametricStudy:
    """A study with its spec and compounds.

    Attributes
    ----------
    plan : StudyPlan
        The fields that vary.
    base : Conveyor
        The spec.
    compounds : mapping
        Compounds named by the points.
    outputs : tuple of str
        Keys of the requested figures.
    """

    plan: VariedSpec
    base: Conveyor
    compounds: Mapping[str, RubberCompound]
    outputs: tuple[str, ...]

    @classmethod
    def of(cls, plan: VariedSpec, base: Conveyor, resolve: Callable[[str], RubberCompound]) -> Self:
        """Resolve the compounds, figures and fields that a plan names.

        Raises
        ------
        InputError
            A compound, figure or field is unknown, or the spec lacks the duty that the plan requires.
        """
        plan = with_states(plan, base)
        resolve = cache(resolve)
        refuse_unknown(plan, base, resolve)
        columns = {path: field_of(base, path) for path in plan.paths}
        rubber = [path for path, value in columns.items() if isinstance(value, RubberCompound)]
        given = {path: plan.axes.get(path, tuple(row[path] for row in plan.together if path in row)) for path in rubber}
        named = {value for values in given.values() for value in values if isinstance(value, str)}
        needed = dict.fromkeys(key for figure in figures_by_name(plan, base).values() for key in figure.needs)
        asked = plan.outputs or (() if plan.figures or plan.best or plan.limits else tuple(select_outputs(())))
        outputs = tuple(select_outputs((*asked, *(key for key in needed if key not in asked))))
        for key in plan.outputs:
            require_year(key, plan, base)
        if plan.outputs or plan.figures or plan.best or plan.limits:
            _refuse_unpriced(plan, base, outputs)
        compounds = {name: resolve(name) for name in sorted(named)}
        return cls(plan, base, compounds, outputs)

    @property
    def rubbers(self) -> tuple[RubberCompound, ...]:
        """Compounds of the points: those that the plan names, and those of covers that it does not change."""
        covers = {"belt.bottom_cover": self.base.carry_compound, "belt.top_cover": self.base.return_compound}
        kept = [
            compound
            for path, compound in covers.items()
            if not {"belt", path, f"{path}.compound"} & set(self.plan.paths)
        ]
        return (*self.compounds.values(), *kept)

    def require_list_plan(self) -> StudyPlan:
        """The plan, if it lists its points.

        Raises
        ------
        InputError
            The plan is a search.
        """
        if not isinstance(self.plan, StudyPlan):
            raise InputError("a plan that searches lists no points; optimise takes it")
        return self.plan

    @cached_property
    def figures(self) -> dict[str, DesignFigure]:
        """Design figures by name."""
        return figures_by_name(self.plan, self.base)

    @property
    def currency(self) -> str:
        """Currency of all costs."""
        return self.plan.currency(self.base)

    @cached_property
    def job(self) -> Job:
        """Inputs common to all batches."""
        return Job.of(self.base, self.asked, self.compounds, self.plan.met)

    @cached_property
    def asked(self) -> tuple[str, ...]:
        """Keys calculated for every point."""
        return required_outputs(self.outputs)

    def answer(self, known: ResultStore, keyed: KeyedPoint) -> Answer:
        """Requested figures of a point whose answer is stored."""
        key, point = keyed
        if not self._costed:
            return price_answer(known[key], self.asked, self.outputs, {}, 0.0)
        hours, operation = self.plan.hours, self.operation(point)
        seconds = operation.seconds_per_year if hours is None and operation else 3600.0 * math.fsum(hours or ())
        return price_answer(known[key], self.asked, self.outputs, self.plan.prices.amounts, seconds)

    @cached_property
    def _costed(self) -> bool:
        """True if parts have prices."""
        return not any(_missing_prices(self.plan, self.base))

    def operation(self, changes: Changes) -> Operation | None:
        """Operating hours and energy price of a point or a design."""
        own = {path: value for path, value in changes.items() if path.startswith("operation.")}
        return with_fields(self.base, own).operation if own else self.base.operation

    @cached_property
    def _common(self) -> hashlib._Hash:
        """Hash of the inputs common to all points, without the spec's fields that affect no answer."""
        idle, said = ["name", "notes", "scenarios", "uncertainty"], [self.asked]
        if all_loads_keys(self.asked):
            said.append(self.plan.met)
        else:
            idle.append("cases")
        if not {"energy_per_year", "cost_per_year"}.intersection(self.asked):
            idle.append("operation")
        return _json_hash([version("conveyor"), fingerprint(self.base, without=idle), *said])

    @cached_property
    def _rubber(self) -> dict[str, dict[Value, str]]:
        """Hashes of the compounds named by points, by field."""
        known: dict[Value, str] = {name: _json_hash(one.as_data()).hexdigest() for name, one in self.compounds.items()}
        return {path: known for path in self.plan.paths if isinstance(field_of(self.base, path), RubberCompound)}

    def key(self, point: Changes) -> bytes:
        """Hash of all inputs of a point's answer."""
        digest = self._common.copy()
        rubber = [known.get(point[path]) for path, known in self._rubber.items()]
        digest.update(json.dumps([point, rubber], sort_keys=True).encode())
        return digest.digest()[:16]


def _missing_prices(plan: VariedSpec, base: Conveyor) -> Iterator[str]:
    """Reasons why no point of a plan can have costs of parts."""
    yield from (f"{field} is not given" for field in missing_price_fields(base) if field not in plan.paths)
    if plan.hours is None and base.operation is None:
        yield "operation.hours_per_year is not given"
    if plan.currency(base) != plan.prices.currency:
        yield f"operation.price is in {plan.currency(base)}, prices are in {plan.prices.currency}"


def _refuse_unpriced(plan: VariedSpec, base: Conveyor, outputs: Iterable[str]) -> None:
    """Reject requested costs of parts that no point can have."""
    for key in outputs:
        why = list(_missing_prices(plan, base)) if OUTPUTS[key].of == "parts" else []
        if why:
            raise InputError(f"{key}: {'; '.join(why)}")


def _json_hash(data: object) -> hashlib._Hash:
    return hashlib.sha256(json.dumps(data, sort_keys=True).encode())


def _row_checksum(key: bytes, text: bytes) -> int:
    """CRC-32 of a key and its answer."""
    return zlib.crc32(text, zlib.crc32(key))


def _is_whole(key: object, text: object, checksum: object) -> bool:
    """True if a row matches its checksum."""
    return isinstance(key, bytes) and isinstance(text, bytes) and _row_checksum(key, text) == checksum


class ResultStore:
    """Append-only file of answers by key, each with its checksum.

    Answers whose checksum does not match (a damaged disk or copy) are removed when the file is opened, with a warning
    that says how many, and calculated anew.

    Raises
    ------
    InputError
        The file holds something else, or another run of the study writes to it.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        try:
            self._file = sqlite3.connect(path, isolation_level=None)
            self._file.text_factory = bytes  # what a lost bit made a text may be no UTF-8
        except sqlite3.OperationalError as error:
            raise InputError(f"{path}: cannot be written ({error})") from None
        try:
            with self._told():
                self._begin()
                damaged = self._take_out_damaged()
        except ConveyorError as error:
            self._file.close()
            raise InputError(str(error)) from None
        if damaged:
            warnings.warn(
                f"{path}: answers that do not match their checksum: {damaged}; they are calculated anew",
                ValidityWarning,
                stacklevel=2,
            )

    def _begin(self) -> None:
        """Create the table in a new file, or in one that a full disk left without it."""
        (mark,) = self._file.execute("PRAGMA application_id").fetchone()
        (pages,) = self._file.execute("PRAGMA page_count").fetchone()
        if pages and mark != _MARK:
            raise InputError(f"{self._path}: holds something else than answers of a study of this version; remove it")
        with self._file:
            self._file.execute("BEGIN IMMEDIATE")
            self._file.execute(f"PRAGMA application_id = {_MARK}")
            self._file.execute(f"CREATE TABLE IF NOT EXISTS answers {_COLUMNS}")

    def _take_out_damaged(self) -> int:
        """Rewrite the table without damaged answers, or where keys lost their order, and return the answers' number."""
        query = "SELECT key, answer, checksum FROM answers"
        damaged = sum(not _is_whole(*row) for row in self._file.execute(query))
        (order,) = self._file.execute("PRAGMA integrity_check(1)").fetchone()
        if damaged or order != b"ok":
            with self._file:
                self._file.execute("BEGIN IMMEDIATE")
                self._file.execute(f"CREATE TABLE whole {_COLUMNS}")
                whole = (row for row in self._file.execute(query) if _is_whole(*row))
                self._file.executemany("INSERT OR IGNORE INTO whole VALUES (?, ?, ?)", whole)
                self._file.execute("DROP TABLE answers")
                self._file.execute("ALTER TABLE whole RENAME TO answers")
        return damaged

    @contextmanager
    def _told(self) -> Iterator[None]:
        """Report why the file cannot be read or written."""
        try:
            yield
        except (sqlite3.DatabaseError, UnicodeDecodeError) as error:  # SQLite quotes what is damaged
            # of a statement of ours SQLite says ERROR where the file's own schema is another
            no_passing = {sqlite3.SQLITE_ERROR, sqlite3.SQLITE_READONLY}
            if isinstance(error, sqlite3.OperationalError) and error.sqlite_errorcode not in no_passing:
                other = "another run of the study writes to it" if "locked" in str(error) else "make room"
                raise ConveyorError(
                    f"{self._path}: cannot be written ({error}; {other}); what is done is kept: run it again to go on"
                ) from None
            raise InputError(
                f"{self._path}: holds something else than answers of a study, or is damaged or read-only ({error}); "
                "remove it"
            ) from None

    def among(self, keys: Sequence[bytes]) -> set[bytes]:
        """The given keys that have answers."""
        query = f"SELECT key FROM answers WHERE key IN ({', '.join('?' * len(keys))})"  # noqa: S608 no text of users
        with self._told():
            return {key for (key,) in self._file.execute(query, keys)}

    def __getitem__(self, key: bytes) -> Answer:
        query = "SELECT answer, checksum FROM answers WHERE key = ?"
        with self._told():
            row = self._file.execute(query, (key,)).fetchone()
        if row is None or not _is_whole(key, *row):
            raise ConveyorError(f"{self._path}: was damaged while the study ran; remove it and run the study again")
        answer: Answer = json.loads(row[0])
        return answer

    def add(self, answers: Iterable[tuple[bytes, Answer]]) -> None:
        """Store answers; all are on the disk when this returns.

        Raises
        ------
        ConveyorError
            They cannot be written: the disk is full, or another run of the study writes.
        """
        texts = [(key, json.dumps(answer).encode()) for key, answer in answers]
        lines = [(key, text, _row_checksum(key, text)) for key, text in texts]
        with self._told(), self._file:
            self._file.execute("BEGIN IMMEDIATE")
            self._file.executemany("INSERT OR IGNORE INTO answers VALUES (?, ?, ?)", lines)

    def __len__(self) -> int:
        with self._told():
            (count,) = self._file.execute("SELECT count(*) FROM answers").fetchone()
        return int(count)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()


@report_lost_worker("study", "; what is done is kept: run it again to go on")
def run_study(
    campaign: ParametricStudy,
    known: ResultStore,
    points: Sequence[Changes] | None = None,
    *,
    executor: Executor | None = None,
    workers: int = 1,
    progress: PointProgress | None = None,
    answered: BatchCallback | None = None,
) -> None:
    """Calculate every point that has no stored answer.

    Parameters
    ----------
    campaign : ParametricStudy
        The study.
    known : ResultStore
        Stored answers; new ones are added batch by batch.
    points : sequence of mapping, optional
        Points; by default all of the plan.
    executor : concurrent.futures.Executor, optional
        Executor of the batches (processes, a cluster); by default this process.
    workers : int
        Workers of the executor; twice as many batches are submitted at once.
    progress : callable, optional
        Called with the points done, their total, and the number without an answer in this run.
    answered : callable, optional
        Called with every batch once all of it has answers, in any order.

    Raises
    ------
    InputError
        Workers outside 1 to 1024.
    ConveyorError
        A worker was lost, or answers cannot be written; what is done is kept, the same call goes on from there.
    """
    whole, every = (
        (campaign.require_list_plan().count, campaign.require_list_plan().points())
        if points is None
        else (len(points), points)
    )
    require_workers(workers)
    asked: dict[Future[list[Answer]], Batch] = {}
    new, most = (
        point_batches(campaign, known, every, whole),
        1 if executor is None else BATCHES_AHEAD * workers,
    )
    done = without = 0
    try:
        while True:
            while len(asked) < most and (batch := next(new, None)) is not None:
                done += len(batch.every) - len(batch.new)
                asked[_submit_batch(campaign.job, batch, executor)] = batch
            if progress is not None:
                progress(done, whole, without)
            if not asked:
                return
            for future in wait(asked, return_when=FIRST_COMPLETED).done:
                batch, fresh = asked.pop(future), future.result()
                known.add(zip(batch.new, fresh, strict=True))
                done += len(batch.new)
                without += sum(isinstance(answer, str) for answer in fresh)
                if answered is not None:
                    answered(batch.every)
    finally:
        for future in asked:
            future.cancel()


class Batch(NamedTuple):
    """Points by number, and those without an answer by key."""

    every: list[tuple[int, KeyedPoint]]
    new: dict[bytes, Changes]


def _submit_batch(job: Job, batch: Batch, executor: Executor | None) -> Future[list[Answer]]:
    """Answers of the new points of a batch: from the executor, or calculated in this process."""
    points = list(batch.new.values())
    if executor is not None and points:
        return executor.submit(evaluate_points, job, points)
    future: Future[list[Answer]] = Future()
    future.set_result(evaluate_points(job, points) if points else [])
    return future


def point_batches(
    campaign: ParametricStudy, known: ResultStore, points: Iterable[Changes], whole: int
) -> Iterator[Batch]:
    """Batches of points, a few hundred of all `whole` at a time, independent of the number of workers.

    A batch is solved together, which sets its last digits, so the order is that of the plan; only points of a window
    that share the fields affecting the rolls of both strands are grouped.
    """
    size = min(BATCH_SIZE, max(SMALLEST_BATCH, -(-whole // LEAST_BATCHES)))
    felt = [path for path in campaign.plan.paths if path.startswith(_BOTH_STRAND_FIELDS)]
    numbered = enumerate(((campaign.key(point), point) for point in points), start=1)
    while window := list(islice(numbered, WINDOW)):
        alike: dict[tuple[Value, ...], list[tuple[int, KeyedPoint]]] = {}
        for number, (key, point) in window:
            alike.setdefault(tuple(point[path] for path in felt), []).append((number, (key, point)))
        ordered = [one for each in alike.values() for one in each]
        for every in (ordered[at : at + size] for at in range(0, len(ordered), size)):
            there = known.among([key for _, (key, _) in every])
            yield Batch(every, {key: point for _, (key, point) in every if key not in there})


def point_results(campaign: ParametricStudy, known: ResultStore) -> Iterator[Point]:
    """Every point, in the order of the plan."""
    return (point_result(campaign, known, number, keyed) for number, keyed in keyed_points(campaign))


def keyed_points(campaign: ParametricStudy) -> Iterator[tuple[int, KeyedPoint]]:
    """Every point with its key and number from 1, in the order of the plan."""
    for number, point in enumerate(campaign.require_list_plan().points(), start=1):
        yield number, (campaign.key(point), point)


def point_result(campaign: ParametricStudy, known: ResultStore, number: int, keyed: KeyedPoint) -> Point:
    """A numbered point whose answer is stored."""
    _, point = keyed
    return number, tuple(point[path] for path in campaign.plan.paths), campaign.answer(known, keyed)


def design_results(campaign: ParametricStudy, known: ResultStore) -> Iterator[Design]:
    """Every design over its states, in the order of the plan."""
    for number, design in enumerate(campaign.require_list_plan().designs(), start=1):
        yield design_result(campaign, known, design, number)


def design_result(campaign: ParametricStudy, known: ResultStore, design: Changes, number: int) -> Design:
    """A design over its states, whose points have answers."""
    keyed = ((campaign.key(point), point) for point in campaign.plan.points_of(design))
    answers = [campaign.answer(known, one) for one in keyed]
    made = reduce_states(campaign.plan, campaign.figures, campaign.outputs, answers, campaign.operation(design))
    return Design(number, design, *made)
