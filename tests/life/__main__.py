"""Run the long forms and print their figures: ``python -m tests.life --runs 2000 --operations 10000``."""

import argparse
import sys
import tempfile
import time
from pathlib import Path

from hypothesis import settings
from hypothesis.stateful import run_state_machine_as_test

from tests.life.machine import JobLives
from tests.life.tenants import Tenants


def main():
    """Run; a break of the job's life ends the program, a leak with 1."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=2000)
    parser.add_argument("--operations", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    begun = time.monotonic()
    run_state_machine_as_test(
        JobLives, settings=settings(max_examples=chosen.runs, deadline=None, database=None, derandomize=True)
    )
    print(f"{chosen.runs} lives of jobs, 0 breaks ({time.monotonic() - begun:.0f} s)", flush=True)
    with tempfile.TemporaryDirectory() as folder, Tenants(Path(folder), chosen.seed) as tenants:
        while tenants.operations < chosen.operations:
            tenants.act()
        print(
            f"{tenants.operations} operations of two tenants, {tenants.crossed} of them on what is the "
            f"other's: {tenants.leaks} cross reads ({time.monotonic() - begun:.0f} s)"
        )
    return 1 if tenants.leaks else 0


if __name__ == "__main__":
    sys.exit(main())
