"""A fit that fails says so in its compound file, and in the report of every conveyor that runs on it."""

from __future__ import annotations

from pathlib import Path

import pytest

import conveyor
from conveyor import shelf
from conveyor.models import RubberCompound
from tests.command_line import run
from tests.rubber.test_shift_variants import isotherms

SPEC = Path(__file__).parent.parent / "examples" / "specs" / "transfer.yaml"


def fitted(folder: Path, **faults: float) -> tuple[str, RubberCompound]:
    """What `conveyor fit` prints of a rubber measured with faults, and the compound it writes."""
    rows = [
        f"{one.temperature - 273.15:.6g},{f:.6g},{storage / 1e6:.6g},{loss / 1e6:.6g}"
        for one in isotherms(**faults)
        for f, storage, loss in zip(one.frequency, one.storage, one.loss, strict=True)
    ]
    data = folder / "isotherms.csv"
    data.write_text("\n".join(["T [degC],frequency [Hz],E' [MPa],E'' [MPa]", *rows, ""]), encoding="utf-8")
    done = run("fit", data, "--at", "20 degC", "-o", "made.yaml", cwd=folder)
    assert done.returncode == 0, done.stderr
    return done.stdout, shelf.compound(str(folder / "made.yaml"))


def warnings_of(compound: RubberCompound) -> str:
    line = conveyor.load(SPEC)
    cover = line.belt.bottom_cover.replace(compound=compound)
    return " ".join(conveyor.analyse(line.replace(belt=line.belt.replace(bottom_cover=cover))).warnings)


def test_a_phase_error_travels_to_the_report(tmp_path):
    printed, compound = fitted(tmp_path, phase=0.15)
    assert "the fit fails; reports that use the compound say so" in printed
    (slope,) = (line for line in compound.fit.failed if line.startswith("E'' over measured frequency"))
    assert slope in printed
    assert "fails, do not design by it" in warnings_of(compound)
    assert slope in warnings_of(compound)


@pytest.mark.parametrize("seed", [1, 2])
def test_a_clean_fit_has_nothing_to_say(tmp_path, seed):
    printed, compound = fitted(tmp_path, seed=seed)
    assert "the fit fails" not in printed
    assert "verdict\n         pass  " in printed
    assert compound.fit.failed == ()
    assert "fails, do not" not in warnings_of(compound)


def test_every_report_says_so(tmp_path):
    """Comparison, sizing, dynamics and studies, which do not warn of the rubber otherwise."""
    fitted(tmp_path, phase=0.15)
    specs = SPEC.parent
    duty = (specs.parent / "duties" / "in_plant.yaml").read_text(encoding="utf-8")
    covers = next(line for line in duty.splitlines() if line.startswith("covers:"))
    (tmp_path / "duty.yaml").write_text(duty.replace(covers, "covers: [made.yaml]"), encoding="utf-8")
    axes = f"{{belt.bottom_cover.compound: [{tmp_path / 'made.yaml'}, standard-cover]}}"
    plan = f"name: covers\nbase: {SPEC}\naxes: {axes}\noutputs: [motor_power]\n"
    (tmp_path / "plan.yaml").write_text(plan, encoding="utf-8")
    long = (specs.parent / "dynamics" / "overland_15km.yaml").read_text(encoding="utf-8")
    (tmp_path / "long.yaml").write_text(long.replace("compound: S100", "compound: made.yaml"), encoding="utf-8")
    for command in (
        ("compare", SPEC, "-c", "made.yaml", "-c", "standard-cover"),
        ("size", "duty.yaml"),
        ("study", "plan.yaml", "-o", "points.csv"),
        ("dynamics", "long.yaml", "--scenario", "start full"),
    ):
        done = run(*command, cwd=tmp_path)
        assert done.returncode in {0, 1}, done.stderr
        assert 'the fit of "isotherms" fails, do not design by it' in " ".join(done.stdout.split()), command
