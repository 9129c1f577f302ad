"""What `make release` holds of the built distributions: `python -m tests.distribution dist`.

Size and contents of the wheel and the source archive, licences of everything that an installation brings, and a fresh
environment without extras in which the commands run from another folder.
"""

from __future__ import annotations

import subprocess
import sys
import tarfile
import tempfile
import venv
import zipfile
from collections.abc import Iterator
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path

from packaging.requirements import Requirement

LARGEST_WHEEL = 3_000_000
"""Size of the wheel at most [bytes]."""
IN_WHEEL = (
    "conveyor/py.typed", "conveyor/_materials/standard-cover.yaml", "conveyor/_examples/specs/overland.yaml",
    "conveyor/_examples/dynamics/overland_15km.yaml", "conveyor/_library/rolls.yaml", "conveyor/_reference/spec.md",
    "conveyor/starter/overland.yaml",
)  # fmt: skip
IN_SOURCE = (
    "LICENSE", "README.md", "CHANGELOG.md", "CONTRIBUTING.md", "CITATION.cff", "Makefile", "mkdocs.yml",
    "tests/promised_names.txt", "docs/README.md", "materials/README.md", "benchmarks/speed.py",
    "examples/06_tutorial.py",
)  # fmt: skip
PERMISSIVE = ("mit", "bsd", "apache", "psf", "python software foundation", "isc", "0bsd", "zlib", "hpnd", "cc0", "mpl")
"""Words of licences that may come with an installation."""
COMMANDS = (
    ("doctor",), ("new", "mine.yaml"), ("power", "mine.yaml", "-o", "mine.xlsx", "-o", "mine.html"), ("shelf",),
    ("compare", "mine.yaml", "-c", "standard-cover", "-c", "low-rolling-resistance-cover"), ("validate",),
    ("template", "input.xlsx"), ("library", "template", "list.xlsx"), ("new", "--kind", "study", "study.yaml"),
)  # fmt: skip
"""Commands that an installation without extras runs."""


def contents(folder: Path) -> Iterator[str]:
    """Faults of size and contents of the wheel and the source archive in a folder."""
    (wheel,), (source,) = sorted(folder.glob("*.whl")), sorted(folder.glob("*.tar.gz"))
    if wheel.stat().st_size > LARGEST_WHEEL:
        yield f"{wheel.name} has {wheel.stat().st_size:,} bytes, {LARGEST_WHEEL:,} at most"
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
    yield from (f"{wheel.name} lacks {name}" for name in IN_WHEEL if name not in names)
    yield from (f"{wheel.name} has {name}" for name in names if name.startswith("tests/") or "__pycache__" in name)
    with tarfile.open(source) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    yield from (f"{source.name} lacks {name}" for name in IN_SOURCE if name not in names)


def licences(name: str = "conveyor") -> dict[str, str]:
    """Licence of a distribution and of all that it needs without extras, by name."""
    found: dict[str, str] = {}
    waiting = [name]
    while waiting:
        one = waiting.pop()
        if one in found:
            continue
        try:
            made = distribution(one)
        except PackageNotFoundError:  # of another system
            continue
        found[one] = _licence(made)
        for line in made.requires or ():
            needed = Requirement(line)
            if needed.marker is None or needed.marker.evaluate({"extra": ""}):
                waiting.append(needed.name.lower())
    return found


def _licence(made: Distribution) -> str:
    about = made.metadata
    of_classifiers = [one.rpartition(" :: ")[2] for one in about.get_all("Classifier", []) if one.startswith("License")]
    return about.get("License-Expression") or ", ".join(of_classifiers) or (about.get("License") or "").split("\n")[0]


def installation(wheel: Path) -> Iterator[str]:
    """Faults of the commands in a fresh environment with the wheel alone, run from another folder."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        venv.create(folder / "env", with_pip=True)
        scripts = folder / "env" / ("Scripts" if sys.platform == "win32" else "bin")
        subprocess.run([scripts / "python", "-m", "pip", "install", "--quiet", wheel.resolve()], check=True)
        for command in COMMANDS:
            done = subprocess.run(
                [scripts / "conveyor", *command], cwd=folder, capture_output=True, text=True, check=False
            )
            if done.returncode != 0:
                yield f"conveyor {' '.join(command)} ends with {done.returncode}: {done.stderr.strip()}"
        desk = subprocess.run(
            [scripts / "conveyor", "desk", "mine.yaml"], cwd=folder, capture_output=True, text=True, check=False
        )
        if "conveyor[desk]" not in desk.stderr:
            yield f"conveyor desk without its extra does not say what to install: {desk.stderr.strip()}"


def main(folder: Path) -> int:
    """Print what is wrong, and the number of faults."""
    faults = list(contents(folder))
    for name, licence in sorted(licences().items()):
        sys.stdout.write(f"{name}: {licence}\n")
        if not any(word in licence.lower() for word in PERMISSIVE):
            faults.append(f'licence of {name}, "{licence}", is none of {", ".join(PERMISSIVE)}')
    faults += installation(next(folder.glob("*.whl")))
    sys.stdout.write("\n".join(faults or ["the distributions are as they should be"]) + "\n")
    return len(faults)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
