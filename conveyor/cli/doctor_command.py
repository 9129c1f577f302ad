"""`conveyor doctor`: what is installed, what is missing, whether it calculates rightly."""

from __future__ import annotations

import os
import platform
import sys
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from time import perf_counter
from typing import Any, Final, NamedTuple

import typer

from conveyor.cli.application import AsJson, app, examples_text, print_json, print_lines

_PACKAGES: Final = (
    "numpy", "scipy", "pandas", "pint", "pydantic", "openpyxl", "typer", "rich", "ruamel.yaml", "matplotlib",
)  # fmt: skip
_EXTRAS: Final = {
    "pdf": (("typst",), "reports as PDF (-o report.pdf)"),
    "desk": (("starlette", "uvicorn"), "the page in the browser (conveyor desk)"),
    "parquet": (("pyarrow",), "tables as Parquet"),
    "cluster": (("dask", "distributed"), "studies on several machines (--scheduler)"),
}
"""Packages of each extra, and its use."""
_CONTACTS: Final = 5  # reference contacts that are solved
_THREAD_VARIABLES: Final = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "CONVEYOR_SHELF")


class InstallationLine(NamedTuple):
    """A line of the answer: what was looked at, what was found, False where that is wrong."""

    subject: str
    found: str
    good: bool = True


@app.command(
    short_help="Check the installation and calculate a few published figures.",
    epilog=examples_text("conveyor doctor", "conveyor doctor --json"),
)
def doctor(as_json: AsJson = False) -> None:
    """Show versions, extras, BLAS and folders, and calculate a few published figures.

    Exit code 1 where something is wrong; what it prints belongs into every report of a fault.
    """
    groups = {
        "program": list(_program_findings()),
        "packages": list(_package_findings()),
        "extras": list(_extra_findings()),
        "machine": list(_machine_findings()),
        "folders": list(_folder_findings()),
        "self test": list(_self_test()),
    }
    wrong = [finding for group in groups.values() for finding in group if not finding.good]
    if as_json:
        plain: dict[str, Any] = {name: {one.subject: one.found for one in group} for name, group in groups.items()}
        print_json({**plain, "wrong": [f"{one.subject}: {one.found}" for one in wrong]})
    else:
        for name, group in groups.items():
            print_lines(name, *(f"  {one.subject:<14} {'' if one.good else 'WRONG: '}{one.found}" for one in group))
        print_lines("", f"{len(wrong)} found wrong" if wrong else "nothing wrong")
    if wrong:
        raise typer.Exit(1)


def _program_findings() -> Iterator[InstallationLine]:
    import conveyor
    from conveyor.files.output_marks import package_version

    yield InstallationLine("conveyor", f"{package_version('conveyor')} in {Path(conveyor.__file__).parent}")
    yield InstallationLine(
        "python", f"{platform.python_version()} ({platform.python_implementation()}), {sys.executable}"
    )
    yield InstallationLine("system", platform.platform())


def _package_version(package: str) -> str | None:
    """Version of a package; None where it is not installed."""
    from importlib import metadata

    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


def _package_findings() -> Iterator[InstallationLine]:
    for package in _PACKAGES:
        version = _package_version(package)
        yield InstallationLine(package, version or "not installed", version is not None)


def _extra_findings() -> Iterator[InstallationLine]:
    for extra, (packages, use) in _EXTRAS.items():
        versions = {package: _package_version(package) for package in packages}
        missing = [package for package, version in versions.items() if version is None]
        if missing:
            found = f'not installed; for {use}: pip install "conveyor[{extra}]"'
        else:
            found = ", ".join(f"{package} {version}" for package, version in versions.items())
        yield InstallationLine(extra, found)


def _machine_findings() -> Iterator[InstallationLine]:
    import numpy as np

    blas = np.show_config(mode="dicts")["Build Dependencies"]["blas"]
    yield InstallationLine("BLAS", f"{blas.get('name', 'unknown')} {blas.get('version', '')}".strip())
    yield InstallationLine("processors", str(os.cpu_count()))
    given = [f"{name}={os.environ[name]}" for name in _THREAD_VARIABLES if name in os.environ]
    yield InstallationLine("variables", ", ".join(given) or "none of " + ", ".join(_THREAD_VARIABLES))


def _folder_findings() -> Iterator[InstallationLine]:
    import tempfile

    from conveyor.errors import ConveyorError
    from conveyor.files.compound_folders import folders

    for subject, folder in (("this folder", Path.cwd()), ("temporary", Path(tempfile.gettempdir()))):
        writable = os.access(folder, os.W_OK)
        yield InstallationLine(
            subject, f"{folder}, {'can' if writable else 'cannot'} be written to", subject != "temporary" or writable
        )
    try:
        for folder in folders():
            compounds = len(list(folder.glob("*.yaml")))
            yield InstallationLine("shelf", f"{folder}, {compounds} compounds", compounds > 0)
    except ConveyorError as error:
        yield InstallationLine("shelf", str(error), good=False)


def _self_test() -> Iterator[InstallationLine]:
    """A few reference contacts, the worked example of ISO 5048, and a conversion of units."""
    from conveyor.units import quantity
    from conveyor.validation.contact_cases import reference_contacts
    from conveyor.validation.reference_cases import iso_5048_example

    begun = perf_counter()
    for name, checks in (
        ("contacts", list(islice(reference_contacts(), _CONTACTS))),
        ("ISO 5048", list(iso_5048_example())),
    ):
        failed = [check for check in checks if not check.passed]
        said = f"{len(checks)} figures as published"
        if failed:
            said = "; ".join(f"{one.quantity}: {one.got}, published {one.expected}" for one in failed)
        yield InstallationLine(name, said, not failed)
    horsepower = quantity("1 hp").to("W").magnitude  # NIST SP 811: 550 ft lbf/s = 745.6999 W
    yield InstallationLine("units", f"1 hp = {horsepower:.4f} W", round(horsepower, 4) == 745.6999)
    yield InstallationLine("time", f"{perf_counter() - begun:.2f} s")
