"""From an input on the desk to its painted figures, in a headless Chromium, beside the NumPy reference of speed.py.

    python benchmarks/desk_latency.py [SPEC]

Real key presses on the page, each with a value that was not asked for before. Time from the event in the page to the
task after the frame that shows the new figures; with it the server's share, the size of an answer, processor times of
server and browser (Linux; what a busy machine does not lengthen), the start until the first figures stand, requests of
a drag of 30 steps, requests to other hosts.
"""

from __future__ import annotations

import os

os.environ["OMP_NUM_THREADS"] = "1"  # before numpy: BLAS reads it once
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import math
import shutil
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from playwright.sync_api import Page, sync_playwright
from speed import reference

ROOT = Path(__file__).resolve().parents[1]
OVERLAND = ROOT / "examples" / "specs" / "overland.yaml"
CHANGES = 40
DRAG_STEPS = 30
FLAGS = ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--no-first-run"]
SPEED = "belt.speed"
DRIVE = "drive.wrap_angle"
PORT = 18765
REST = 3.0
"""Time after which the page is in the middle of its curves [s]."""
LONGEST = 60.0
"""Time that a change may take [s]."""

WATCH = """() => {
  const watch = window.watch = { begun: 0, painted: 0, asked: [] };
  const channel = new MessageChannel();
  channel.port1.onmessage = () => { if (watch.begun && !watch.painted) watch.painted = performance.now(); };
  for (const kind of ["input", "change"])
    document.addEventListener(kind, (event) => { watch.begun ||= event.timeStamp; }, true);
  new MutationObserver(() => {
    const wanted = document.querySelector("#command").textContent.includes(watch.wanted);
    if (watch.begun && wanted) requestAnimationFrame(() => channel.port2.postMessage(0));
  }).observe(document.querySelector("#command"), { childList: true, characterData: true, subtree: true });
  const ask = window.fetch;
  window.fetch = async (path, given) => {
    const begun = performance.now(), reply = await ask(path, given);
    if (path === "/answer") {
      const text = await reply.clone().text();
      watch.asked.push({ whole: performance.now() - begun, size: text.length, server: 1e3 * JSON.parse(text).seconds });
    }
    return reply;
  };
}"""


@contextmanager
def open_desk(spec: Path, folder: Path) -> Iterator[tuple[str, float, int]]:
    """A desk in a process of its own: its address, when it was begun [s], its number."""
    shutil.copy(spec, folder / spec.name)
    command = [sys.executable, "-m", "conveyor.cli", "desk", spec.name, "--no-browser", "--port", str(PORT)]
    begun = time.perf_counter()
    path = os.pathsep.join(filter(None, (str(ROOT), os.environ.get("PYTHONPATH"))))
    with subprocess.Popen(
        command, cwd=folder, stdout=subprocess.PIPE, text=True, env=os.environ | {"PYTHONPATH": path}
    ) as process:
        try:
            assert process.stdout is not None  # noqa: S101
            yield process.stdout.readline().removeprefix("desk:").strip(), begun, process.pid
        finally:
            process.terminate()


def wait_until(page: Page, script: str) -> Any:
    """Value of a script of the page as soon as it is true."""
    end = time.monotonic() + LONGEST
    while not (found := page.evaluate(script)):
        if time.monotonic() > end:
            raise TimeoutError(script)
        time.sleep(0.02)
    return found


def processor_time(process: int) -> tuple[float, float]:
    """Processor time of a process, and of the browser, which this one has begun [s]; nan where there is no /proc."""
    ticks, parents = dict[int, float](), dict[int, int]()
    for path in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            fields = path.read_text(encoding="utf-8").rpartition(")")[2].split()
            parents[int(path.parent.name)] = int(fields[1])
            ticks[int(path.parent.name)] = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def is_below(one: int) -> bool:
        return one == os.getpid() or (one in parents and is_below(parents[one]))

    others = [time for one, time in ticks.items() if one not in {process, os.getpid()} and is_below(one)]
    return ticks.get(process, math.nan), sum(others) if ticks else math.nan


def painted(page: Page, wanted: str, press: str, selector: str) -> float:
    """Milliseconds from a key press to the frame with the figures of a value."""
    page.evaluate("(wanted) => Object.assign(watch, { begun: 0, painted: 0, wanted })", wanted)
    page.press(selector, press)
    return float(wait_until(page, "watch.painted && watch.painted - watch.begun"))


def typed(page: Page, path: str, text: str) -> float:
    """Milliseconds from Enter in a field to the frame with its figures."""
    field = f"input[type=text][data-path='{path}']"
    page.evaluate("(wanted) => Object.assign(watch, { begun: 0, painted: 0, wanted })", f"{path}={text}")
    page.fill(field, text)
    page.evaluate("() => { watch.begun = 0; }")  # of typing; Enter counts
    page.press(field, "Enter")
    return float(wait_until(page, "watch.painted && watch.painted - watch.begun"))


def drag_requests(page: Page) -> tuple[int, float]:
    """Answers asked for while a slider is dragged by the mouse, and how long it was dragged [s]."""
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url) if request.url.endswith("/answer") else None)
    box = page.locator(f"[data-range='{SPEED}']").bounding_box()
    assert box is not None  # noqa: S101
    x, y = box["x"] + 0.3 * box["width"], box["y"] + 0.5 * box["height"]
    page.mouse.move(x, y)
    page.mouse.down()
    begun = time.perf_counter()
    for step in range(1, DRAG_STEPS + 1):
        page.mouse.move(x + 3 * step, y)
        time.sleep(1.0 / 60.0)  # a hand is seen at the rate of the screen
    page.mouse.up()
    lasted = time.perf_counter() - begun
    time.sleep(0.5)  # the last answer, before the curves
    return len(asked), lasted


def measure(page: Page, server: int) -> None:
    """Print milliseconds of every kind of change, and what server and browser took of them."""

    def told(name: str, change: Callable[[int], float], count: int = CHANGES, rest: float = 0.0) -> None:
        change(0)
        page.evaluate("watch.asked.splice(0)")
        unit, times, busy = 1e3 * reference(), list[float](), [0.0, 0.0]
        for i in range(1, count + 1):
            time.sleep(rest)
            before = processor_time(server)
            times.append(change(i))
            busy = [one + now - then for one, now, then in zip(busy, processor_time(server), before, strict=True)]
        unit = 0.5 * (unit + 1e3 * reference())
        asked = page.evaluate("watch.asked.splice(0)")
        print(f"{name}; a reference takes {unit:.2f} ms")
        for what, found in (
            ("input to painted", times),
            ("request and answer", [one["whole"] for one in asked]),
            ("in the server", [one["server"] for one in asked]),
        ):
            middle, late = statistics.median(found), statistics.quantiles(found, n=20)[-1]
            print(f"  {what:<40} {middle:9.1f} {late:9.1f} {middle / unit:9.1f} {late / unit:9.1f}")
        for what, spent in zip(("server", "browser"), busy, strict=True):
            mean = 1e3 * spent / count
            print(f"  {f'processor time of the {what}, mean':<40} {mean:9.1f} {'':9} {mean / unit:9.1f}")
        sizes = statistics.median(one["size"] for one in asked)
        print(f"  {'kilobytes of an answer':<40} {1e-3 * sizes:9.1f}", flush=True)

    slider = f"[data-range='{SPEED}']"
    page.evaluate("() => document.querySelector('aside').scrollTo(0, 0)")
    told("belt speed, typed", lambda i: typed(page, SPEED, f"{4.02 + 0.03 * i:.2f} m/s"))
    typed(page, SPEED, "4.93 m/s")
    told(
        "belt speed, by a key on its slider: first figures",
        lambda _: painted(page, "conveyor power", "ArrowRight", slider),
    )
    typed(page, SPEED, "5.01 m/s")
    page.fill("#find", DRIVE)
    told("wrap of the drive alone", lambda i: typed(page, DRIVE, f"{180 + 0.7 * i:.1f} deg"))
    told("while curves are calculated", lambda i: typed(page, SPEED, f"{4.41 + 0.03 * i:.2f} m/s"), CHANGES // 4, REST)


def main() -> None:
    spec = Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else OVERLAND
    print(f"{'milliseconds; references':<42} {'median':>9} {'p95':>9} {'median':>9} {'p95':>9}")
    foreign: list[str] = []
    with TemporaryDirectory() as folder, sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        with open_desk(spec, Path(folder)) as (address, begun, server):
            served = time.perf_counter() - begun
            page = browser.new_page(viewport={"width": 1440, "height": 900})
            page.on("request", lambda request: foreign.append(request.url) if _is_foreign(request.url) else None)
            page.goto(address)
            page.wait_for_selector("#answer:not([hidden])")
            shown = time.perf_counter() - begun
            page.evaluate(WATCH)
            measure(page, server)
            print(f"address printed after {served:.2f} s, first figures after {shown:.2f} s")
            count, lasted = drag_requests(page)
            print(f"a drag of {DRAG_STEPS} steps in {lasted:.1f} s: {count} requests")
            print(f"requests to other hosts: {len(foreign)}")
        browser.close()


def _is_foreign(url: str) -> bool:
    return not url.startswith((f"http://127.0.0.1:{PORT}/", "data:", "blob:"))


if __name__ == "__main__":
    main()
