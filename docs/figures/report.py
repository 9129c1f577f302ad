"""Draw the pictures of docs/gallery.md and the first sheet of a fit: `python docs/figures/report.py`.

Needs chromium, soffice and pdftoppm.
"""

from __future__ import annotations

import subprocess
import tempfile
from pathlib import Path

from PIL import Image

FOLDER = Path(__file__).parent
SPECS = FOLDER.parent.parent / "examples" / "specs"
COVERS = ("standard-cover", "low-rolling-resistance-cover", "cold-resistant-cover")
COLOURS = 48  # of a palette: pages of text stay readable, a picture stays below 100 kB


def run(*command: str | Path) -> None:
    """A program; its failure is ours."""
    subprocess.run([str(word) for word in command], check=True, capture_output=True)  # noqa: S603 fixed commands


def picture(source: Path, name: str, width: int, height: int | None = None) -> None:
    """A page at the width of a column, its first part where a height is given, with a palette."""
    image = Image.open(source).convert("RGB")
    image = image.crop((0, 0, image.width, min(image.height, height or image.height)))
    image = image.resize((width, round(image.height * width / image.width)), Image.Resampling.LANCZOS)
    image.quantize(COLOURS).save(FOLDER / f"report_{name}.png", optimize=True)


def of_pdf(path: Path, name: str) -> None:
    """Its first page."""
    run("pdftoppm", "-r", "130", "-f", "1", "-l", "1", "-png", "-singlefile", path, path.with_suffix(""))
    picture(path.with_suffix(".png"), name, 800)


def of_workbook(path: Path, name: str) -> None:
    """Its first page, as LibreOffice prints it."""
    run("soffice", "--headless", "--convert-to", "pdf", "--outdir", path.parent, path)
    of_pdf(path.with_suffix(".pdf"), name)


def of_page(path: Path, name: str, size: tuple[int, int], width: int, *options: str) -> None:
    """The top of a page in a window of a size."""
    shot, window = path.with_suffix(".png"), f"--window-size={size[0]},{size[1]}"
    quiet = ("--headless", "--no-sandbox", "--hide-scrollbars")
    run("chromium", *quiet, window, f"--screenshot={shot}", *options, path.as_uri())
    picture(shot, name, width, size[1])


def main() -> None:
    """All of them."""
    covers = [word for name in COVERS for word in ("-c", name)]
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        book, page, compared = folder / "a.xlsx", folder / "a.html", folder / "c.xlsx"
        sheets = folder / "sheets.pdf"
        run("conveyor", "power", SPECS / "overland_10km.yaml", "-o", book, "-o", page, "-o", sheets)
        run("conveyor", "compare", SPECS / "overland.yaml", *covers, "--temperature=-20:40:20", "-o", compared)
        laboratory = [SPECS.parent / "laboratory" / name for name in ("isotherms.csv", "relaxation.txt", "ramp.csv")]
        stated = ("--document", "number=2026-17", "--document", "by=A. Tester")
        fit = folder / "acme-7.pdf"
        run("conveyor", "fit", *laboratory, "--at", "20 degC", "--name", "acme-7", *stated,
            "--spec", SPECS / "overland.yaml", "-o", fit)  # fmt: skip
        of_pdf(fit, "fit")
        of_workbook(book, "workbook")
        of_pdf(sheets, "pdf")
        of_workbook(compared, "comparison")
        of_page(page, "page", (1280, 1500), 800)
        of_page(page, "dark", (1280, 1000), 800, "--blink-settings=preferredColorScheme=0")
        of_page(page, "phone", (500, 1100), 400)


if __name__ == "__main__":
    main()
