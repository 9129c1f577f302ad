"""What a desk holds: the open files, and the one place where their variants are calculated."""

from __future__ import annotations

import difflib
import hashlib
from collections import OrderedDict
from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

from conveyor import spec
from conveyor.assessment import Assessment
from conveyor.calculated_conveyor import CalculatedConveyor, Variant
from conveyor.desk.design_form import DesignField, form_rows, read_change
from conveyor.desk.design_sliders import Slider
from conveyor.desk.design_variant import TextChanges, change_conveyor, guarded_resolver
from conveyor.desk.stop_signal import StopSignal
from conveyor.errors import ConveyorError, InputError
from conveyor.files.atomic_write import save_files
from conveyor.files.compound_folders import folders
from conveyor.files.document import fault_lines, read_document, yaml_text
from conveyor.files.edit import edit_values
from conveyor.files.file_bytes import file_content
from conveyor.models import Conveyor
from conveyor.models.fields import CompoundResolver
from conveyor.pipeline import calculate, calculate_many
from conveyor.reuse import ReuseCache
from conveyor.shelf import names as shelf_names
from conveyor.studies import CalculatedStudies
from conveyor.studies.flooding import flooded_belt
from conveyor.studies.loads import every_load

SPEC_ENDINGS: Final = (".yaml", ".yml", ".json")
LARGEST_SPEC: Final = 5_000_000
"""Bytes, as of every spec."""
_MOST_BESIDE: Final = 200
"""Files beside a spec that are looked at for compounds."""
_ANSWERS_KEPT: Final = 24
"""Assessments kept for undo and comparison, the last used."""


@dataclass(frozen=True, eq=False)
class OpenFile:
    """A file on the desk.

    Attributes
    ----------
    name : str
        Name on the page.
    path : Path
        Where it is read from.
    folder : Path
        Where it is saved, and paths of compounds start.
    conveyor : Conveyor
        The spec.
    data : mapping
        Plain data as written.
    content : str or None
        Its text; None for a workbook, which is saved as a new spec.
    state : tuple of int
        Time and size of the file as read.
    own : bool
        Whether it lies where its user keeps it; else it was dropped in or made anew and is not saved yet.
    """

    name: str
    path: Path
    folder: Path
    conveyor: Conveyor
    data: Mapping[str, Any]
    content: str | None
    state: tuple[int, int]
    own: bool

    @property
    def digest(self) -> str:
        """SHA-256 of its text, by which a page knows it again."""
        return hashlib.sha256((self.content or str(self.data)).encode()).hexdigest()[:16]

    @property
    def saved_name(self) -> str:
        """Name under which it is saved unless another is given."""
        return self.path.name if self.content is not None else f"{Path(self.name).stem}.yaml"


@dataclass
class Workbench:
    """Open files by name, and the calculations of their variants; one at a time.

    Attributes
    ----------
    folder : Path
        Where new files are saved.
    shelves : tuple of Path
        Further folders of compounds.
    """

    folder: Path
    shelves: tuple[Path, ...] = ()
    _files: dict[str, OpenFile] = field(default_factory=dict, repr=False)
    _forms: dict[tuple[str, str], tuple[DesignField, ...]] = field(default_factory=dict, repr=False)
    _kept: ReuseCache = field(default_factory=ReuseCache, repr=False)
    _answers: OrderedDict[tuple[Hashable, bool], Assessment] = field(default_factory=OrderedDict, repr=False)

    def __post_init__(self) -> None:
        self._drawer = TemporaryDirectory(prefix="conveyor-desk-")

    def close(self) -> None:
        """Remove the copies of files that were dropped in."""
        self._drawer.cleanup()

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the open files."""
        return tuple(self._files)

    def open_path(self, path: Path) -> OpenFile:
        """Open a file that the user named on the command line.

        Raises
        ------
        InputError
            As `conveyor.load`.
        """
        return self._keep(path, path.parent, own=True)

    def open_content(self, name: str, content: bytes) -> OpenFile:
        """Open a spec or a filled-in template that was dropped on the page, or a new one.

        Raises
        ------
        InputError
            Its name is no file name of a spec, or as `conveyor.load`.
        """
        if Path(name).suffix.lower() not in {*SPEC_ENDINGS, ".xlsx"}:
            raise InputError(f'"{name}": a spec ends in .yaml, .yml or .json, a filled-in template in .xlsx')
        check_file_name(name)
        path = Path(self._drawer.name) / name
        path.write_bytes(content)
        try:
            return self._keep(path, self.folder, own=False)
        except InputError as error:
            raise InputError(str(error).replace(f"{path.parent}/", "").replace(f"{path.parent}\\", "")) from None

    def _keep(self, path: Path, folder: Path, *, own: bool, name: str | None = None) -> OpenFile:
        given = name or path.name
        if name is None:
            known = self._files.get(given)
            if known is not None and known.path.resolve() != path.resolve():
                given = next(
                    made for i in range(2, len(self._files) + 3)
                    if (made := f"{path.stem} ({i}){path.suffix}") not in self._files
                )  # fmt: skip
        state = path.stat() if path.exists() else None
        content, data, line = self._read(path, folder, own=own)
        mark = (0, 0) if state is None else (state.st_mtime_ns, state.st_size)
        opened = OpenFile(given, path, folder, line, data, content, mark, own)
        self._files[given] = opened
        return opened

    def _read(self, path: Path, folder: Path, *, own: bool) -> tuple[str | None, Mapping[str, Any], Conveyor]:
        if path.suffix.lower() == ".xlsx":
            from conveyor.forms.form_reader import read_template

            filled = read_template(path)
            if not own:
                _check_compounds(filled.data, guarded_resolver(folder, self.shelves))
            line = spec.from_data(filled.data, where=filled.where, shelves=self.shelves, base=folder)
            return None, filled.data, line
        if own:
            line = spec.load(path, shelves=self.shelves)
            document = read_document(path)
        else:
            document = read_document(path)
            if document.findings:
                raise InputError(fault_lines(path.name, document.findings))
            _check_compounds(document.data, guarded_resolver(folder, self.shelves))
            line = spec.from_data(
                document.data,
                where=lambda at: "{}:{}:{}".format(path.name, *document.place(at)),
                shelves=self.shelves,
                base=folder,
            )
        return (
            file_content(path, largest=LARGEST_SPEC, expected="spec").decode("utf-8"),
            document.data,
            line,
        )

    def file(self, name: str) -> OpenFile:
        """Open file of a name, read again where it was changed by another program.

        Raises
        ------
        InputError
            No such file is open, or it was changed and is refused.
        """
        known = self._files.get(name)
        if known is None:
            raise InputError(f'"{name}" is not open; there are {", ".join(self._files) or "no files"}')
        try:
            state = known.path.stat()
        except OSError:
            return known  # deleted meanwhile: what was read is still here
        if (state.st_mtime_ns, state.st_size) == known.state:
            return known
        return self._keep(known.path, known.folder, own=known.own, name=name)

    def form(self, name: str) -> tuple[DesignField, ...]:
        """Fields of an open file."""
        of = self.file(name)
        key = (name, of.digest)
        if key not in self._forms:
            self._forms[key] = form_rows(of.conveyor, of.data)
        return self._forms[key]

    def compounds(self, name: str) -> list[str]:
        """Compounds that the covers of a file may have: of the shelves, and files beside it."""
        of = self.file(name)
        beside = sorted(path for path in of.folder.glob("*") if path.suffix.lower() in SPEC_ENDINGS)
        return [*shelf_names(self.shelves), *(path.name for path in beside[:_MOST_BESIDE] if _is_compound(path))]

    def resolver(self, name: str) -> CompoundResolver:
        """Look-up of compounds for changes of a file."""
        return guarded_resolver(self.file(name).folder, self.shelves)

    def variant(self, name: str, changes: TextChanges) -> Conveyor:
        """Conveyor of a file with the changes of a page.

        Raises
        ------
        InputError
            Refused; a line for each field, with its path.
        """
        of = self.file(name)
        return change_conveyor(of.conveyor, changes, self.resolver(name), self._kept)

    def assess(self, conveyor: Conveyor, stop: StopSignal, *, every: bool = True) -> Assessment:
        """Calculate a variant: its own load alone, or every load, as `conveyor power` does.

        Parameters
        ----------
        conveyor : Conveyor
            The variant.
        stop : StopSignal
            Ends the calculation early.
        every : bool
            False: the own load alone, which comes sooner.

        Raises
        ------
        NoSolutionError, RangeError, InputError
            The variant has no answer.
        CalculationStopped
            It was stopped.
        """
        key = (conveyor.fingerprint, every)
        known = self._answers.pop(key, None)
        made = self._calculate(conveyor, stop, every=every) if known is None else known
        self._answers[key] = made
        while len(self._answers) > _ANSWERS_KEPT:
            self._answers.popitem(last=False)
        return made

    def _calculate(self, conveyor: Conveyor, stop: StopSignal, *, every: bool) -> Assessment:
        self._kept.begin()
        stop.check()
        known = self._answers.get((conveyor.fingerprint, False))
        own = calculate(conveyor, self._kept) if known is None else known.own
        if not every:
            return Assessment(own)
        stop.check()
        loads = every_load(conveyor, own, progress=stop.check, kept=self._kept)
        stop.check()
        return Assessment(loads.own, CalculatedStudies(states=loads.states, cases=loads.cases))

    def with_flooded_belt(self, assessment: Assessment) -> Assessment:
        """Return an assessment with the flooded belt, which only tables by name and JSON show."""
        held = assessment.studies
        if held.states is None or held.flooded is not None:
            return assessment
        return replace(assessment, studies=replace(held, flooded=flooded_belt(assessment.own, self._kept)))

    def curves(
        self, name: str, changes: TextChanges, sliders: Sequence[Slider], stop: StopSignal
    ) -> list[list[tuple[float, float | None]]]:
        """Motor power of the own load over the range of each slider, a batch for each [W].

        Parameters
        ----------
        name : str
            The open file.
        changes : mapping
            Changes of the page; a slider's own is left out.
        sliders : sequence of Slider
            The fields.
        stop : StopSignal
            Ends the calculation early.

        Returns
        -------
        list of list of (float, float or None)
            Values in the slider's unit with the power there; None where a value has no answer.
        """
        return [self._curve(name, changes, slider, stop) for slider in sliders]

    def _curve(
        self, name: str, changes: TextChanges, slider: Slider, stop: StopSignal
    ) -> list[tuple[float, float | None]]:
        """Power at the values of one slider; small batches give way to the figures sooner than one large one."""
        values = slider.curve_values()
        given = [self._variant_or_none(name, changes, slider, value) for value in values]
        stop.check()
        asked = [Variant(one) for one in given if one is not None]
        results = iter(calculate_many(asked, progress=stop.check, kept=self._kept) if asked else ())
        power: list[float | None] = []
        for one in given:
            result = None if one is None else next(results)
            power.append(result.balance.power.motor if isinstance(result, CalculatedConveyor) else None)
        return list(zip(values, power, strict=True))

    def passing(self, name: str, changes: TextChanges, slider: Slider, value: float, stop: StopSignal) -> bool | None:
        """Tell whether a variant passes every check in every load at a value of a slider; None without an answer."""
        made = self._variant_or_none(name, changes, slider, value)
        if made is None:
            return None
        try:
            return not any(check.failed for check in self.assess(made, stop).governing)
        except ConveyorError:
            return None

    def _variant_or_none(self, name: str, changes: TextChanges, slider: Slider, value: float) -> Conveyor | None:
        others = {path: text for path, text in changes.items() if path != slider.path}
        try:
            return self.variant(name, {**others, slider.path: slider.text(value)})
        except ConveyorError:
            return None

    def changed_text(self, name: str, changes: TextChanges) -> str:
        """Text of a file with the changes of a page, everything else as it was.

        Raises
        ------
        InputError
            The variant is refused, or a value cannot be changed in place.
        """
        of = self.file(name)
        made = self.variant(name, changes)
        if of.content is None:
            return yaml_text(made.as_data(), width=110)
        typed = {path: read_change(path, text) for path, text in changes.items()}
        return edit_values(of.content, typed, of.path)

    def difference(self, name: str, changes: TextChanges, target: str) -> list[str]:
        """Lines that saving changes: of the target where there is one, else of the file.

        Raises
        ------
        InputError
            As `changed_text`; the target is no file name of a spec.
        """
        of = self.file(name)
        text = self.changed_text(name, changes)
        path = self._target(of, target)
        there = path.is_file() and (of.own or path != of.path)
        before = file_content(path, largest=LARGEST_SPEC, expected="spec").decode("utf-8", "replace") if there else ""
        lines = difflib.unified_diff(before.splitlines(), text.splitlines(), n=1, lineterm="")
        return [line for line in lines if not line.startswith(("---", "+++"))]

    def save(self, name: str, changes: TextChanges, target: str, digest: str, *, overwrite: bool) -> OpenFile:
        """Save a variant as a spec in the folder of its file.

        Parameters
        ----------
        name : str
            The open file.
        changes : mapping
            Changes of the page.
        target : str
            Name of the file to write.
        digest : str
            `OpenFile.digest` of what the page was made from.
        overwrite : bool
            Whether another file of that name may be replaced.

        Returns
        -------
        OpenFile
            The file as it is now open.

        Raises
        ------
        InputError
            The file was changed by another program, another file would be replaced, or it cannot be written.
        """
        of = self.file(name)
        if of.digest != digest:
            raise InputError(f"{of.name}: another program has changed it; look at it again, then save")
        path = self._target(of, target)
        same = of.own and path.resolve() == of.path.resolve()
        if path.exists() and not same and not overwrite:
            raise InputError(f"{path.name}: exists; choose another name, or replace it")
        save_files({path: self.changed_text(name, changes).encode("utf-8")})
        if not of.own:
            del self._files[name]  # it lies in the user's folder from now on
        return self._keep(path, path.parent, own=True, name=name if same else None)

    def _target(self, of: OpenFile, target: str) -> Path:
        check_file_name(target)
        allowed = SPEC_ENDINGS if of.content is None else (Path(of.name).suffix.lower(),)
        if Path(target).suffix.lower() not in allowed:
            raise InputError(f'"{target}": the name ends in {" or ".join(allowed)}, as that of {of.name}')
        return of.folder / target


def check_file_name(name: str) -> None:
    """Refuse what is no plain name of a file.

    Raises
    ------
    InputError
        It is empty, too long, hidden, or names a folder.
    """
    plain = name == Path(name).name and not set(name) & set('/\\:*?"<>|\0') and name.isprintable()
    if not plain or name.startswith(".") or not 0 < len(name) <= 120:
        raise InputError(f'"{name[:120]}": is no name of a file; letters, digits, spaces, - and _ will do')


def _check_compounds(data: Mapping[str, Any], resolve: CompoundResolver) -> None:
    """Refuse a spec from the page whose covers name files outside the folder."""
    belt = data.get("belt")
    for cover in ("top_cover", "bottom_cover"):
        held = belt.get(cover) if isinstance(belt, Mapping) else None
        name = held.get("compound") if isinstance(held, Mapping) else None
        if isinstance(name, str):
            resolve(name)


def _is_compound(path: Path) -> bool:
    """True for a file with the look of a compound; nothing else is offered as one."""
    try:
        return b"reference_temperature" in file_content(path, largest=LARGEST_SPEC, expected="compound file")
    except InputError:
        return False


def open_workbench(paths: Iterable[Path], shelves: Iterable[Path]) -> Workbench:
    """Open a workbench with files.

    Raises
    ------
    InputError
        A file is refused, or a shelf does not exist.
    """
    given = tuple(paths)
    listed = tuple(path.resolve() for path in shelves)
    folders(listed)  # a folder that does not exist is refused before the page opens
    made = Workbench(given[0].resolve().parent if given else Path.cwd(), listed)
    try:
        for path in given:
            made.open_path(path.resolve())
    except InputError:
        made.close()
        raise
    return made
