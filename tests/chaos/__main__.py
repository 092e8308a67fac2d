"""Run the long form, on SQLite and on PostgreSQL, and print its figures: ``python -m tests.chaos``."""

import argparse
import sys
from contextlib import ExitStack

from tests.app.postgres import binaries, cluster, new_database
from tests.chaos.run import chaos


def main():
    """Run; end with 1 where anything was lost, double, wrong or left over."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--jobs", type=int, default=1000)
    parser.add_argument("--kills", type=int, default=300)
    parser.add_argument("--freezes", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--database", choices=("sqlite", "postgresql", "both"), default="both")
    chosen = parser.parse_args()
    databases = ("sqlite", "postgresql") if chosen.database == "both" else (chosen.database,)
    clean = True
    for database in databases:
        if database == "postgresql" and binaries() is None:
            print("SKIPPED FOR WANT OF POSTGRESQL: initdb is not there (Debian: apt install postgresql)")
            continue
        with ExitStack() as stack:
            url = new_database(stack.enter_context(cluster())) if database == "postgresql" else None
            wanted = {"jobs": chosen.jobs, "kills": chosen.kills, "freezes": chosen.freezes}
            figures, failures = chaos(**wanted, seed=chosen.seed, url=url, tell=_tell)
        _tell(f"{database}: killed {failures.kills}, froze {failures.freezes}; {figures}")
        clean &= figures.clean
    return 0 if clean else 1


def _tell(text):
    print(text, flush=True)


if __name__ == "__main__":
    sys.exit(main())
