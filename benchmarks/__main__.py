"""Run benchmarks by name, or all of them: ``python -m benchmarks [names] [--quick]``.

Threads inside the linear algebra are switched off before numpy is loaded.
"""

import argparse
import importlib
import os

NAMES = (
    "regressor",
    "simulation",
    "pipeline",
    "cost",
    "hour",
    "programme",
    "exported",
    "light_tips",
    "nelder_mead",
    "bootstrap",
    "coverage",
    "estimators",
    "diagnosis",
    "measured",
    "uploads",
    "polling",
    "posting",
    "half_open",
    "overhead",
)
ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


def main() -> None:
    """Read the command line and print one table per benchmark."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks", description=(__doc__ or "").partition("\n")[0]
    )
    parser.add_argument("names", nargs="*", metavar="name", help=f"any of {', '.join(NAMES)}; all by default")
    parser.add_argument("--quick", action="store_true", help="small inputs: everything in about a minute")
    parser.add_argument("--profile", action="store_true", help="of diagnosis: which functions cost most")
    arguments = parser.parse_args()
    unknown = sorted(set(arguments.names) - set(NAMES))
    if unknown:
        parser.error(f"there is no benchmark {unknown[0]!r}; there are {', '.join(NAMES)}")
    if arguments.profile and arguments.names != ["diagnosis"]:
        parser.error("--profile is of diagnosis alone: python -m benchmarks diagnosis --profile")
    os.environ.update(dict.fromkeys(ONE_THREAD, "1"))
    figures = importlib.import_module("benchmarks.figures")
    for name in arguments.names or NAMES:
        module = importlib.import_module(f"benchmarks.{name}")
        run = module.profile if arguments.profile else module.run
        figures.show((module.__doc__ or "").partition("\n")[0], run(quick=arguments.quick))


if __name__ == "__main__":
    main()
