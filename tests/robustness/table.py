"""The table of cases for people: input, message, exit code. Run this file to write it anew."""

from __future__ import annotations

import os
import re
import tempfile
from dataclasses import dataclass
from pathlib import Path

from tests import command_line
from tests.robustness.arrange import Case
from tests.robustness.cases import CASES

TABLE = Path(__file__).with_name("table.md")
_HEADING = """\
# What the way in says

Each row is a case of `tests/robustness/cases.py`: the input, what the command line says of it on stderr, its exit code
(1 no solution, 2 wrong input, 130 Ctrl-C). The tests hold this table against what is said; write it anew with
`python -m tests.robustness.table`. Long messages are shortened here (…).

| input | message | exit code |
| --- | --- | --- |
"""
_LONGEST = 330


@dataclass(frozen=True)
class Outcome:
    """What a run left behind."""

    code: int
    out: str
    err: str
    before: dict[str, bytes | None]
    after: dict[str, bytes | None]


def files(folder: Path) -> dict[str, bytes | None]:
    """Every file below a folder with its bytes; None for what is no ordinary file."""
    return {
        str(path.relative_to(folder)): path.read_bytes() if path.is_file() else None
        for path in sorted(folder.rglob("*"))
    }


def run(case: Case, folder: Path) -> Outcome:
    """Run a case in a folder of its own, in this process."""
    arguments, before = case.arrange(folder), files(folder)
    done = command_line.run(*arguments, cwd=folder, columns=120, spoil=case.spoil)
    return Outcome(done.returncode, done.stdout, done.stderr, before, files(folder))


def row(case: Case, outcome: Outcome) -> str:
    """Write a case as a row."""
    said = re.sub(re.escape(str(Path(__file__).parents[2])) + "/?", "", outcome.err.strip())
    lines = [line if len(line) <= _LONGEST else line[:_LONGEST] + "…" for line in said.splitlines()]
    if len(lines) > 3:
        lines = [*lines[:3], f"… and {len(lines) - 3} more lines"]
    cells = "<br>".join(f"`` {line} ``" for line in lines).replace("|", "\\|")
    return f"| {case.group}: {case.title} | {cells} | {outcome.code} |"


def recorded() -> dict[str, str]:
    """Rows of the table by their first cell."""
    rows = [line for line in TABLE.read_text(encoding="utf-8").splitlines() if line.startswith("| ")][2:]
    return {line.split(" | ")[0].removeprefix("| "): line for line in rows}


def write() -> None:
    """Run every case and write the table."""
    rows = []
    for case in CASES:
        with tempfile.TemporaryDirectory() as folder:
            rows.append(row(case, run(case, Path(os.path.realpath(folder)))))
    TABLE.write_text(_HEADING + "\n".join(rows) + f"\n\n{len(rows)} cases.\n", encoding="utf-8")


if __name__ == "__main__":
    write()
