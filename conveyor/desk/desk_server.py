"""Serves the desk: the page, and the answers to what it asks."""

from __future__ import annotations

import asyncio
import socket
import time
from collections.abc import Awaitable, Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, Final, TypeVar

import uvicorn
from starlette.applications import Starlette
from starlette.requests import ClientDisconnect, Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import Route

from conveyor.assessment import Assessment
from conveyor.desk.answer_parts import (
    NamedAssessment,
    answer_parts,
    named_figure,
    named_table,
    own_load_parts,
    table_names,
)
from conveyor.desk.design_sliders import Slider, choose_sliders, conveyor_kind, field_slider
from conveyor.desk.design_variant import TextChanges, command_line, field_errors
from conveyor.desk.further_studies import offered_studies, study_part
from conveyor.desk.report_files import REPORTS, report_bytes
from conveyor.desk.request_guard import LOOPBACK, RequestGuard
from conveyor.desk.request_values import (
    file_answer,
    request_data,
    text_value,
    units_value,
    variant_changes,
    variant_names,
)
from conveyor.desk.stop_signal import CalculationStopped, StopSignal
from conveyor.desk.study_export import study_text
from conveyor.desk.workbench import Workbench
from conveyor.errors import ConveyorError, InputError
from conveyor.files.output_marks import package_version
from conveyor.report.tables.result_schema import analysis_json
from conveyor.starter import KINDS, starter_text
from conveyor.units.presentation import display_unit
from conveyor.units.unit_systems import SYSTEMS, report_system

T = TypeVar("T")

IDLE_SECONDS: Final = 3600.0
"""Time after the last request at which the desk ends by itself [s]; open pages call every five minutes."""
_PAGE: Final = Path(__file__).parent / "page"
MOST_STUDY_SECONDS: Final = 600.0
"""Time limit of a report or a longer study [s]."""
_WATCH_SECONDS: Final = 0.03
"""Interval at which a waiting request looks whether its page has gone on [s]."""
_REFUSED: Final = 422


class Desk:
    """The desk's answers, over one workbench.

    Parameters
    ----------
    workbench : Workbench
        Its files and calculations.
    """

    def __init__(self, workbench: Workbench) -> None:
        self.workbench = workbench
        self._worker = ThreadPoolExecutor(1, thread_name_prefix="desk")
        self._running: set[StopSignal] = set()
        self._ended = False
        self._background: set[StopSignal] = set()
        self._studies: dict[str, StopSignal] = {}

    def begin(self) -> None:
        """Calculate the first file while the browser opens."""
        for name in self.workbench.names[:1]:
            self._worker.submit(self._first_answer, name)

    def _first_answer(self, name: str) -> None:
        with suppress(ConveyorError):  # the page says what is wrong
            self.workbench.form(name)
            self.workbench.assess(self.workbench.file(name).conveyor, StopSignal())

    def stop(self) -> None:
        """Stop the calculations at their next step; their requests are answered at once."""
        self._ended = True
        for signal in tuple(self._running):
            signal.stop()

    def close(self) -> None:
        """End the calculations."""
        self.stop()
        self._worker.shutdown(wait=False, cancel_futures=True)

    def app(self) -> Starlette:
        """The application, without its guard."""
        answers: dict[str, Callable[[Request], Awaitable[Response]]] = {
            "/files": self._files, "/form": self._form, "/answer": self._answer, "/curves": self._curves,
            "/passing": self._passing, "/table": self._table, "/result": self._result,
            "/difference": self._difference, "/save": self._save, "/report": self._report, "/study": self._study,
            "/further": self._further,
            "/progress": self._progress,
            "/drop": self._drop, "/new": self._new,
        }  # fmt: skip
        routes = [Route(path, _answer_errors(made), methods=["POST"]) for path, made in answers.items()]
        pages = {"/": "desk.html", "/desk.css": "desk.css", "/desk.js": "desk.js"}
        routes += [Route(path, partial(_page_file, name=name)) for path, name in pages.items()]
        return Starlette(routes=routes)

    async def _calculate(
        self, request: Request, work: Callable[[StopSignal], T], *, background: bool = False, seconds: float = 60.0
    ) -> T:
        """Do work in the one thread that calculates; it is stopped where its page goes on.

        Work of a page's first rank stops what runs in the background.
        """
        stop = StopSignal(seconds)
        self._running.add(stop)
        if background:
            self._background.add(stop)
        else:
            for other in tuple(self._background):
                other.stop()
        running = asyncio.get_running_loop().run_in_executor(self._worker, _checked_work, work, stop)
        try:
            while not running.done():
                await asyncio.wait({running}, timeout=_WATCH_SECONDS)
                if self._ended and not running.done():
                    running.add_done_callback(_forget_answer)
                    raise CalculationStopped
                if not running.done() and await request.is_disconnected():
                    stop.stop()
            return running.result()
        finally:
            self._running.discard(stop)
            self._background.discard(stop)

    async def _files(self, _: Request) -> Response:
        """Open files, kinds of new ones, reports that can be made."""
        return JSONResponse({
            "files": self.workbench.names, "kinds": KINDS, "systems": list(SYSTEMS), "reports": list(REPORTS),
            "folder": str(self.workbench.folder), "version": package_version("conveyor"),
        })  # fmt: skip

    async def _form(self, request: Request) -> Response:
        """Fields of a file, its sliders and compounds."""
        asked = await request_data(request)
        name = text_value(asked, "file")

        def made(_: StopSignal) -> dict[str, Any]:
            of, rows = self.workbench.file(name), self.workbench.form(name)
            return {
                "file": name, "title": of.conveyor.name, "digest": of.digest, "saved": of.saved_name, "own": of.own,
                "folder": str(of.folder),
                "kind": conveyor_kind(of.conveyor), "units": of.conveyor.report.units,
                "rows": [row.plain() for row in rows],
                "sliders": [slider.plain() for slider in choose_sliders(of.conveyor, rows)],
                "compounds": self.workbench.compounds(name),
                "studies": offered_studies(of.conveyor),
            }  # fmt: skip

        return JSONResponse(await self._calculate(request, made))

    def _assess(
        self, name: str, changes: TextChanges, units: str | None, stop: StopSignal, *, every: bool = True
    ) -> Assessment:
        line = self.workbench.variant(name, changes)
        made = self.workbench.assess(line, stop, every=every)
        return made.in_units(report_system(line.report.units, units))

    async def _answer(self, request: Request) -> Response:
        """Pieces of the page for a variant, and beside another one; errors by field."""
        asked = await request_data(request)
        name, units, every = text_value(asked, "file"), units_value(asked), asked.get("every") is not False
        changes, other = variant_changes(asked, "changes"), variant_changes(asked, "beside")
        titles = variant_names(asked)

        def answered(stop: StopSignal) -> dict[str, Any]:
            begun = time.perf_counter()
            rank = 1 if asked.get("second") is True else 0
            made = self._assess(name, changes, units, stop, every=every)
            shown = NamedAssessment.of(titles[rank], rank, made)
            beside = None
            problem: list[dict[str, str]] = []
            if other is not None:
                try:
                    made = self._assess(name, other, units, stop, every=every)
                    beside = NamedAssessment.of(titles[1 - rank], 1 - rank, made)
                except ConveyorError as error:
                    problem = _error_list(error)
            parts = (answer_parts if every else own_load_parts)(shown, beside)
            return {
                "parts": {key: str(part) for key, part in parts.items()},
                "every": every, "seconds": round(time.perf_counter() - begun, 4), "beside": problem,
                "command": command_line(name, changes), "digest": self.workbench.file(name).digest,
            }  # fmt: skip

        return JSONResponse(await self._calculate(request, answered))

    async def _result(self, request: Request) -> Response:
        """The figures of a variant as `conveyor power --json` gives them."""
        asked = await request_data(request)
        name, changes = text_value(asked, "file"), variant_changes(asked, "changes") or {}
        made = await self._calculate(
            request,
            lambda stop: analysis_json(self.workbench.with_flooded_belt(self._assess(name, changes, None, stop))),
        )
        return JSONResponse(made)

    async def _curves(self, request: Request) -> Response:
        """Power over the range of each slider."""
        asked = await request_data(request)
        name, changes = text_value(asked, "file"), variant_changes(asked, "changes") or {}
        curves = await self._calculate(
            request,
            lambda stop: self.workbench.curves(name, changes, self._sliders(name, asked), stop),
            background=True,
        )
        own = self.workbench.file(name).conveyor.report.units
        unit = display_unit("power", report_system(own, units_value(asked)), large=True)
        shown = [[(value, None if power is None else float(unit(power))) for value, power in curve] for curve in curves]
        return JSONResponse({"curves": shown, "unit": unit.sign})

    async def _passing(self, request: Request) -> Response:
        """Tell whether every check passes at the values of a slider."""
        asked = await request_data(request)
        name, changes = text_value(asked, "file"), variant_changes(asked, "changes") or {}

        def made(stop: StopSignal) -> list[bool | None]:
            found = []
            (slider, *_) = self._sliders(name, asked)
            for value in slider.curve_values():
                stop.check()
                found.append(self.workbench.passing(name, changes, slider, value, stop))
            return found

        return JSONResponse({"passing": await self._calculate(request, made, background=True)})

    def _sliders(self, name: str, asked: Mapping[str, Any]) -> list[Slider]:
        """Sliders of the fields that a page names."""
        values = {row.path: row.value for row in self.workbench.form(name)}
        paths = asked.get("paths")
        made = [field_slider(path, values.get(path)) for path in paths] if isinstance(paths, list) else []
        if not made or len(made) > 12 or None in made:
            raise InputError("paths: expected fields with a number")
        return [slider for slider in made if slider is not None]

    async def _table(self, request: Request) -> Response:
        """Names of the tables and figures of a variant, or one of them."""
        asked = await request_data(request)
        name, changes, units = text_value(asked, "file"), variant_changes(asked, "changes") or {}, units_value(asked)
        key = asked.get("key")

        def made(stop: StopSignal) -> dict[str, Any]:
            of = self.workbench.with_flooded_belt(self._assess(name, changes, units, stop))
            if not isinstance(key, str) or not key:
                return {"tables": table_names(of)}
            shown = named_figure(of, key) or named_table(of, key)
            if shown is None:
                raise InputError(f"{key}: no table or figure of this conveyor")
            return {"table": str(shown)}

        return JSONResponse(await self._calculate(request, made))

    async def _difference(self, request: Request) -> Response:
        """Lines of the file that saving changes."""
        asked = await request_data(request)
        name, changes, target = (
            text_value(asked, "file"),
            variant_changes(asked, "changes") or {},
            text_value(asked, "target"),
        )
        lines = await self._calculate(request, lambda _: self.workbench.difference(name, changes, target))
        of = self.workbench.file(name)
        path = of.folder / target
        same = of.own and path == of.path
        return JSONResponse({"lines": lines, "folder": str(of.folder), "exists": path.exists() and not same})

    async def _save(self, request: Request) -> Response:
        """Save a variant as a spec."""
        asked = await request_data(request)
        name, changes, target = (
            text_value(asked, "file"),
            variant_changes(asked, "changes") or {},
            text_value(asked, "target"),
        )
        digest, overwrite = text_value(asked, "digest"), asked.get("replace") is True
        made = await self._calculate(
            request, lambda _: self.workbench.save(name, changes, target, digest, overwrite=overwrite)
        )
        where = {"file": made.name, "saved": made.path.name, "folder": str(made.folder)}
        return JSONResponse({**where, "files": self.workbench.names})

    async def _report(self, request: Request) -> Response:
        """Workbook, page or PDF of a variant, with its studies, as the command line writes it."""
        asked = await request_data(request)
        name, changes, units = text_value(asked, "file"), variant_changes(asked, "changes") or {}, units_value(asked)
        kind = text_value(asked, "kind")

        def made(stop: StopSignal) -> bytes:
            line = self.workbench.variant(name, changes)
            return report_bytes(line, kind, report_system(line.report.units, units), stop.check)

        content = await self._calculate(request, made, seconds=MOST_STUDY_SECONDS)
        return file_answer(content, f"{Path(name).stem}{REPORTS[kind].ending}", REPORTS[kind].media_type)

    async def _study(self, request: Request) -> Response:
        """A study file of the file and the variants of the page."""
        asked = await request_data(request)
        name = text_value(asked, "file")
        variants = [made for key in ("changes", "beside") if (made := variant_changes(asked, key)) is not None]
        text = study_text(self.workbench.file(name), self.workbench.form(name), variants)
        return file_answer(text.encode(), f"{Path(name).stem}-study.yaml", "application/yaml")

    async def _further(self, request: Request) -> Response:
        """Tables of a study that takes longer."""
        asked = await request_data(request)
        name, changes, units = text_value(asked, "file"), variant_changes(asked, "changes") or {}, units_value(asked)
        key, number = text_value(asked, "key"), text_value(asked, "id")

        def made(stop: StopSignal) -> str:
            self._studies[number] = stop
            try:
                return str(study_part(self._assess(name, changes, units, stop), key, stop.check))
            finally:
                del self._studies[number]

        return JSONResponse({"part": await self._calculate(request, made, background=True, seconds=MOST_STUDY_SECONDS)})

    async def _progress(self, request: Request) -> Response:
        """Items done of a study that runs, and their total; 0 of 0 of one that does not."""
        running = self._studies.get(text_value(await request_data(request), "id"))
        told = [item for item in ([] if running is None else running.told) if isinstance(item, int)]
        return JSONResponse({"done": told[0] if told else 0, "whole": told[1] if len(told) > 1 else 0})

    async def _drop(self, request: Request) -> Response:
        """Open a spec or template that was dropped on the page."""
        name, content = request.query_params.get("name", ""), await request.body()
        made = await self._calculate(request, lambda _: self.workbench.open_content(name, content))
        return JSONResponse({"file": made.name, "files": self.workbench.names})

    async def _new(self, request: Request) -> Response:
        """Open a new spec of a kind."""
        asked = await request_data(request)
        kind, units = text_value(asked, "kind"), units_value(asked)
        if kind not in KINDS:
            raise InputError(f"kind: {' or '.join(KINDS)}")
        name = f"{kind}.yaml"
        content = starter_text(kind, report_system("SI", units), file=name).encode()
        made = await self._calculate(request, lambda _: self.workbench.open_content(name, content))
        return JSONResponse({"file": made.name, "files": self.workbench.names})


def _checked_work(work: Callable[[StopSignal], T], stop: StopSignal) -> T:
    """Do work unless it was stopped while it waited."""
    stop.check()
    return work(stop)


def _forget_answer(late: asyncio.Future[T]) -> None:
    """Look at the end of a calculation that nobody waits for, or asyncio tells of it."""
    if not late.cancelled():
        late.exception()


def _answer_errors(answer: Callable[[Request], Awaitable[Response]]) -> Callable[[Request], Awaitable[Response]]:
    """Wrap an answer: refusals become errors by field, stopped ones say so."""

    async def answered(request: Request) -> Response:
        try:
            return await answer(request)
        except (CalculationStopped, ClientDisconnect):
            return JSONResponse({"stopped": True})
        except ConveyorError as error:
            return JSONResponse({"errors": _error_list(error)}, _REFUSED)

    return answered


def _error_list(error: ConveyorError) -> list[dict[str, str]]:
    """A refusal as plain data, by field."""
    return [one._asdict() for one in field_errors(str(error))]


async def _page_file(_: Request, name: str) -> Response:
    return FileResponse(_PAGE / name)


class _Server(uvicorn.Server):
    """A server that stops the calculations of its requests before it waits for these."""

    def __init__(self, config: uvicorn.Config, desk: Desk) -> None:
        super().__init__(config)
        self._desk = desk

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """End as uvicorn does, without calculations that nobody waits for."""
        self._desk.stop()
        await super().shutdown(sockets)


@dataclass
class DeskServer:
    """A desk on a port of this machine.

    Attributes
    ----------
    workbench : Workbench
        Its files.
    port : int
        Port; another free one where it is taken.
    idle_seconds : float
        Time after the last request at which it ends by itself [s].
    host : str
        Address of this machine that it listens to.
    password : str or None
        Opens the page from other machines; needed with another host than the loopback address.

    Raises
    ------
    InputError
        The host is no address of this machine, has no free port, or no password goes with it.
    """

    workbench: Workbench
    port: int = 0
    idle_seconds: float = IDLE_SECONDS
    host: str = LOOPBACK
    password: str | None = field(default=None, repr=False)
    guard: RequestGuard = field(init=False)

    def __post_init__(self) -> None:
        if self.host != LOOPBACK and not self.password:
            raise InputError(f"host {self.host}: other machines reach it, so it needs a password")
        self._socket = _listening_socket(self.host, self.port)
        self.port = self._socket.getsockname()[1]
        self._desk = Desk(self.workbench)
        self.guard = RequestGuard(self._desk.app(), self.port, host=self.host, password=self.password)
        config = uvicorn.Config(
            self.guard,
            lifespan="off",
            log_level="error",
            access_log=False,
            ws="none",
            server_header=False,
            timeout_graceful_shutdown=1,
        )
        self._server = _Server(config, self._desk)

    def stop(self) -> None:
        """End `run` from another thread."""
        self._server.should_exit = True

    def run(self) -> None:
        """Serve until Ctrl-C, or until no page has called for `idle_seconds`."""

        async def serve() -> None:
            self._desk.begin()
            watch = asyncio.ensure_future(self._end_when_idle())
            try:
                await self._server.serve(sockets=[self._socket])
            finally:
                watch.cancel()

        try:
            asyncio.run(serve())
        finally:
            self._desk.close()
            self._socket.close()
            self.workbench.close()

    async def _end_when_idle(self) -> None:
        while time.monotonic() - self.guard.last_request < self.idle_seconds:
            await asyncio.sleep(min(5.0, 0.25 * self.idle_seconds))
        self.stop()


def _listening_socket(host: str, port: int) -> socket.socket:
    """Socket on an address of this machine, on a free port where the given one is taken."""
    for tried in dict.fromkeys((port, 0)):
        made = socket.socket(proto=socket.IPPROTO_TCP)  # named, or asyncio leaves a 40 ms wait for packets in it
        made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            made.bind((host, tried))
        except OSError:
            made.close()
            continue
        made.listen(64)
        return made
    raise InputError(f"host {host}: no address of this machine, or no port of it is free")
