"""Draw docs/figures/desk.png: `python docs/figures/desk_page.py`; needs chromium, playwright and pillow."""

from __future__ import annotations

import shutil
import tempfile
import threading
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

from conveyor.desk.desk_server import DeskServer
from conveyor.desk.workbench import open_workbench

FOLDER = Path(__file__).parent
SPEC = FOLDER.parent.parent / "examples" / "specs" / "overland.yaml"
COLOURS = 250  # of a palette: pale grounds and lines keep theirs
SLIDERS = 6


def main() -> None:
    """The desk with the overland example, every curve below its sliders calculated."""
    with tempfile.TemporaryDirectory() as made, sync_playwright() as started:
        shutil.copy(SPEC, made)
        server = DeskServer(open_workbench([Path(made) / SPEC.name], ()))
        thread = threading.Thread(target=server.run)
        thread.start()
        browser = started.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1440, "height": 900})
        page.goto(server.guard.address)
        while page.locator(".curve[aria-label*=passes]").count() < SLIDERS:
            page.wait_for_timeout(200)
        shot = Path(made) / "desk.png"
        page.screenshot(path=shot)
        browser.close()
        server.stop()
        thread.join()
        Image.open(shot).convert("RGB").quantize(COLOURS, kmeans=2).save(FOLDER / "desk.png", optimize=True)


if __name__ == "__main__":
    main()
