"""docs/validation.md: every shipped figure and every file of tests/validation is on it, and the figures hold.

``python tests/test_validation_page.py`` writes the page.
"""

from __future__ import annotations

import ast
import re
from functools import cache
from itertools import groupby
from pathlib import Path

import pytest

from conveyor.validation import reference_cases
from conveyor.validation.reference_check import ReferenceCheck
from tests.validation.test_measured_conveyors import rows as measured

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "docs" / "validation.md"

SOURCES = {
    "Bessel-Galerkin prototype": "a separate prototype, itself compared with a brute-force solver in real space "
    "(`conveyor/_reference/contact_cases.json`)",
    "two-strip derivation": "a separate derivation for contacts of two strips, confirmed by a grid solver to 1e-5",
    "Hunter (1961)": "S. C. Hunter, The rolling contact of a rigid cylinder with a viscoelastic half space, J. "
    "Appl. Mech. (1961), closed form; rolls far apart, shallow contact",
    "CONTACT program": "two viscoelastic cylinders of the CONTACT program's documentation, 600 N/mm, "
    "equivalent R 50 mm, G∞ 1143, G0 571.5 N/mm², ν 0.4; printed digits",
    "ISO 5048 worked example": "itemised example after ISO 5048: coal, 2300 t/h, 4.8 m/s, 143 m level, belt 1.2 m; "
    "printed digits",
    "Helix shaft report": "a printed sheet of Helix's pulley shaft program (AS 1403), tail pulley CV212: resultant, "
    "bending moment, torque; printed digits",
    "Helix feeder load calculation": "a printed sheet of Helix delta-T, feeder ZC01-FD001 under a slot hopper, lump "
    "coal; printed digits; its load in flow lacks the divisor 4 tan α that the balance below the outlet asks for "
    "([special_belts.md](special_belts.md#belt-feeders))",
    "Shortt (2019), idler of 127 mm, bearings 6305": "G. Shortt, Why idlers fail, bulk-online research paper 2146, "
    "example 1.2: ISO 281, two bearings alike; printed digits",
    "NEMA MG 10, table 2-3": "the example of the EASA handbook, 122/50; printed digits",
    "ISO 5293:2004": "the standard's formula of the transition length, which strips of straight way come to at full "
    "trough",
    "Grimmer, Kessler (1987), by eytelwein 0.1.9": "K.-J. Grimmer, F. Kessler, Spezielle Betrachtungen zur "
    "Gurtführung bei Gurtförderern mit Horizontalkurven: their worked belt from the tests of the open library "
    "eytelwein, ten and more digits; the paper was not read",
    "course of a flat belt, set by set": "a belt turned at every set by banking and guiding friction; allowed is "
    "the way over which it turns back to the straight, over the length",
    "polygon of five rolls": "area by the shoelace formula, force on the drifted belt by the heights of its edges",
    "catenary between the sets": "the chain's own curve; allowed is its next term beyond the parabola, 4/3 of the sag "
    "squared",
    "least cost of the sets, by search": "every millimetre tried; allowed is half of one",
    "Lemmon (2013), finite elements": "R. Lemmon, Belt transitions analysis by finite element analysis, Beltcon 17, "
    "table 3: belt of 1600 mm, 600 kN, 13.0 m; strength, stiffness and rolls are inferred, so 1 % is allowed",
    "CEMA, transition": "L = 0.707 sqrt(E/Δσ (s² + z²)), the edge's own way, as lectured at Newcastle (Belt conveying, "
    "transitions); pulley at full and half depth",
    "ISO 5048, cross-section": "example of the public repository ScottMcCormack/conveyance: trough of 45 deg, slope of "
    "20 deg, 1.03 m of belt under the bulk; printed digits",
    "Helix delta-T reports": "printed for Curragh North C3, pipe conveyor PC01, BC-01: sag tension and take-up (two "
    "on 4 strands) to every digit, power at the belt to those of the tension",
    "Conveyor C-1.1 report": "a public calculation report (studylib 25593897): belt of 1250 N/mm, 1200 mm; "
    "its tensions printed to three digits",
    "ckit.co.za, trajectories": "its table of edge distances on discharge pulleys; printed digits",
    "Sandvik (1999), load of idlers": "Selection and load rating of the idlers for belt conveyors (12/99): 1300 t/h "
    "at 2.2 m/s, 45 deg, slope of 30 deg; printed digits, of the middle roll those of its share",
    "Rulmeca, impact rollers": "its rule for fine bulk, t/h times the root of the fall over 8 in kgf, as commonly "
    "reproduced; one printed digit",
    "J*(ω) E*(ω) = 1": "the exact inverse of a relaxation spectrum, 21 terms over 20 decades",
    "Song et al. (2012)": "J. China Coal Society 37 (2012) S1, 217: 600 t/h at 2.5 m/s, EA 104 MN; printed digits",
    "Nordell and Ciozda (1984), measured": "Bulk Solids Handling 4 (1984) 93, stop of a loaded belt of 2.5 km, its "
    "front timed at two places; lengths and wave speeds theirs, 1.5 % for a cell and their chart",
    "Harrison (1983, 1985), measured": "Beltcon 2 and 3: start of an empty belt of 5.1 km, 20 t in its take-up, "
    "three wound-rotor motors; read from charts. The motors, which set the slow period, are not printed; our drive "
    "is led",
    "Lodewijks (1996), finite elements": "PhD thesis, Delft, table 8.7: loaded 1 km, starts of 30 s; half of the "
    "rise of his resistances with speed is assumed, 15 % allowed. These four after the open repository "
    "daniel-gonzalezm/beltloop, whose author read the papers",
}
FILES = {
    "test_belt_cases": "a belt of two covers and a carcass: six contacts of a separate implementation, three "
    "methods on one belt",
    "test_belt_waves": "waves in a rod against closed forms: c m' v, reflections, periods, damping ratio, second "
    "order, a weight on a spring",
    "test_boundary_elements": "boundary elements in real space, the paper's route, against the spectral solver and "
    "closed forms; order of errors",
    "test_closed_forms": "the closed forms themselves: Hunter, Hertz, Winkler foundation, Jonkers; printed figures, "
    "40-digit arithmetic, quadrature, limits",
    "test_contact_program": "the CONTACT program's cylinders through the solver, printed digits",
    "test_hunter_1961": "Hunter's half-plane over modulus ratios and memories; differences fall as theory says",
    "test_iso_5048": "ISO 5048, DIN 22101's C, VDI 2341's shares, every printed digit",
    "test_measured_conveyors": "friction measured or printed, with the package's covers and defaults",
    "test_menga_2019": "the paper's limits and claims with our numbers, and its errata",
    "test_pc01": "a printed pipe conveyor with as much friction empty as full, which no stiffness of its belt explains",
    "test_pipe_strip": "the belt bent to a pipe against a chain of links of least energy: small turns, and the "
    "elastica between flat rolls",
    "test_reference_cases": "42 contacts computed elsewhere at two tolerances; the estimated errors hold",
    "test_rulmeca_cema": "CEMA's classic form against two printed sheets of Rulmeca's program, item by item",
    "test_split_contacts": "contacts of two strips against a derivation and the grid over the range of Fig. 4",
    "test_start_stop_limits": "starts and stops against our steady tensions, quasi-static start and rigid coasting; "
    "energy and momentum",
    "test_winkler_trends": "thin bonded layers: Winkler, the incompressible thin film, powers of the load",
}
HEAD = """\
# Validation

What the package was compared with. First what `conveyor validate` computes on your machine in some seconds, then
measured conveyors, then what the test suite adds. Beside these stand the 24 claims of [paper.md](paper.md).
`python tests/test_validation_page.py` writes this page; a test holds its figures.

*Deviation* is relative; of lengths over the roll's radius, in units of it. *Allowed* is half a unit of the source's
last digit, its own error, or the difference between the two problems. Measured conveyors are compared in bands, for no
openly licensed measurement with its rubber's spectrum was found. What the models leave out:
[assumptions.md](assumptions.md#assumptions).

## `conveyor validate`
"""


@cache
def checks() -> tuple[ReferenceCheck, ...]:
    return tuple(reference_cases.run_reference_checks())


def shown(value: float | str) -> str:
    return f"{value:.8g}" if isinstance(value, float) else value


def written() -> str:
    lines = [HEAD]
    for source, group in groupby(checks(), key=lambda check: check.source):
        rows = list(group)
        lines += [
            f"### {source.replace('*', chr(92) + '*')}",
            "",
            f"{SOURCES[source][0].upper()}{SOURCES[source][1:]}.",
            "",
        ]
        lines += ["| quantity | expected | got | deviation | allowed |", "|---|---|---|---|---|"]
        lines += [
            f"| {c.quantity.replace('|', chr(92) + '|')} | {shown(c.expected)} | {shown(c.got)} | {c.deviation:.0e} | "
            f"{c.tolerance:.0e} |"
            for c in rows
        ]
        lines.append("")
    lines += [
        "## Measured conveyors",
        "",
        "With covers of the shelf and unchanged defaults; the specs, `tests/validation/conveyors/*.yaml`, say what is "
        "assumed. Henderson PC2 (f 0.0075 measured) and Channar (0.0085 to 0.011) are not calculated, because rolls, "
        "spacings and covers are not printed; a report warns where f is below 0.0075.",
        "",
        "| quantity | measured or printed | ours | ratio | band | |",
        "|---|---|---|---|---|---|",
    ]
    lines += [
        f"| {row.what} | {row.printed:g} | {row.ours:.3g} | {row.ratio:.2f} | {row.band[0]:g} to {row.band[1]:g} | "
        f"{row.why} |"
        for row in measured()
    ]
    lines += ["", "## The test suite", "", "| file in `tests/validation` | holds | tests |", "|---|---|---|"]
    lines += [
        f"| `{path.name}` | {FILES[path.stem]} | {functions(path)} functions |"
        for path in sorted((ROOT / "tests" / "validation").glob("test_*.py"))
    ]
    lines += [
        "",
        "`tests/laws` holds every law to its closed form, limit or printed figure, `tests/properties` random contacts "
        "to invariances and the first law, `tests/line` whole conveyors to conservation: forces add up to the "
        "effective tension, the loop of tensions closes, splitting a section changes nothing.",
        "",
    ]
    return "\n".join(lines)


def functions(path: Path) -> int:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return sum(isinstance(node, ast.FunctionDef) and node.name.startswith("test_") for node in tree.body)


def key(quantity: str) -> str:
    """Which contact is the worst may differ from machine to machine."""
    return quantity.partition("worst of all")[0].replace("|", "\\|")


def rows_of(text: str) -> list[list[str]]:
    lines = (line for line in text.splitlines() if line.startswith("| ") and not line.startswith("| quantity"))
    return [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]


def test_every_figure_is_on_the_page_and_holds() -> None:
    table = {key(row[0]): row for row in rows_of(PAGE.read_text(encoding="utf-8")) if len(row) == 5}
    for check in checks():
        _, expected, got, _, allowed = table[key(check.quantity)]
        assert allowed == f"{check.tolerance:.0e}"
        if "worst of all" in check.quantity:
            assert check.passed
            continue
        assert expected == shown(check.expected)
        if isinstance(check.expected, float):
            # the page may come from another machine: it holds to the tolerance of the figure, and half of its 8th digit
            slack = check.tolerance * max(abs(check.expected), 1.0) + 5e-8 * abs(check.expected)
            assert float(got) == pytest.approx(check.expected, abs=slack)
        assert check.passed


def test_no_row_is_left_from_an_older_figure() -> None:
    rows = [row for row in rows_of(PAGE.read_text(encoding="utf-8")) if len(row) == 5]
    assert len(rows) == len(checks()) == len({row[0] for row in rows})


def test_every_source_is_described() -> None:
    assert {check.source for check in checks()} == set(SOURCES)


def test_every_validation_file_is_described() -> None:
    files = {path.stem for path in (ROOT / "tests" / "validation").glob("test_*.py")}
    assert files == set(FILES)
    text = PAGE.read_text(encoding="utf-8")
    assert all(f"`{name}.py`" in text for name in files)


if __name__ == "__main__":
    PAGE.write_text(written(), encoding="utf-8")
