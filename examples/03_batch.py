"""Many conveyors at once: one process per core, or a Dask cluster (`pip install conveyor[cluster]`).

python examples/03_batch.py                          local processes
python examples/03_batch.py --scheduler tcp://host:8786    a running Dask scheduler
"""

import argparse
import os
from concurrent.futures import Executor, ProcessPoolExecutor
from pathlib import Path

# One BLAS thread a worker: the matrices are small, more threads only get in each other's way.
for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")

import conveyor
from conveyor.units import quantity

SPEC = Path(__file__).parent / "specs" / "overland.yaml"


def motor_power(case: tuple[conveyor.Conveyor, float]) -> float:
    """Motor power [kW] of a conveyor at a belt temperature [degC]; models travel as plain text."""
    line, celsius = case
    warm = line.ambient.replace(temperature=quantity(f"{celsius} degC", "temperature"))
    return conveyor.analyse(line.replace(ambient=warm)).balance.power.motor / 1e3


def executor(scheduler: str | None) -> Executor:
    if scheduler is None:
        return ProcessPoolExecutor()
    from dask.distributed import Client

    return Client(scheduler).get_executor()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scheduler")
    line = conveyor.load(SPEC)
    temperatures = [-30.0, -20.0, -10.0, 0.0, 10.0, 20.0, 30.0, 40.0]
    with executor(parser.parse_args().scheduler) as pool:
        powers = pool.map(motor_power, [(line, celsius) for celsius in temperatures])
        for celsius, power in zip(temperatures, powers, strict=True):
            print(f"{celsius:6.1f} degC  {power:8.1f} kW")


if __name__ == "__main__":
    main()
