"""Ask the service all its contract allows and much that it forbids: ``python -m tests.contract --cases n``.

The service really listens, and computes nothing: jobs end at once. It has the log of the example requests, so
that there are jobs.
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

from tests.app.http.test_server import listening_service
from tests.app.stubs import StubExecutor
from veritorque.app.client.client import Client
from veritorque.app.main import create_app
from veritorque.app.settings import Settings

LOG = Path(__file__).parents[2] / "examples" / "yumi" / "log.csv"
CONFIGURATION = Path(__file__).with_name("schemathesis.toml")
CHECKS = (
    "not_a_server_error",
    "status_code_conformance",
    "content_type_conformance",
    "response_headers_conformance",
    "response_schema_conformance",
    "negative_data_rejection",
    "positive_data_acceptance",
    "unsupported_method",
    "allow_header_conformance",
    "use_after_free",
    "ensure_resource_availability",
)


def examine(directory: Path, *, cases: int, seed: int) -> subprocess.CompletedProcess[str]:
    """Run about so many cases against a service of its own, and give how that ended."""
    operations = sum(len(methods) for methods in create_app(Settings()).openapi()["paths"].values())
    executor = StubExecutor()
    executor.release.set()
    plenty = {"requests_per_second": 1e6, "queued_per_tenant": 10**6, "disk_reserve_bytes": 0}
    with listening_service(directory, executor, **plenty) as (_, port):
        with Client(f"http://127.0.0.1:{port}") as client:
            client.upload(LOG)
        command = [
            *(sys.executable, "-m", "schemathesis.cli", "--config-file", str(CONFIGURATION)),
            *("run", f"http://127.0.0.1:{port}/openapi.json"),
            *("--max-examples", str(max(cases // operations, 1)), "--seed", str(seed)),
            *("--checks", ",".join(CHECKS), "--continue-on-failure", "--no-color", "--warnings", "off"),
            *("--generation-database", "none", "--request-timeout", "70", "--workers", "2"),
            *("--suppress-health-check", "all"),
        ]
        return subprocess.run(command, cwd=directory, capture_output=True, text=True, check=False)


def main() -> None:
    """Read the command line, and print what came out."""
    parser = argparse.ArgumentParser(prog="python -m tests.contract")
    parser.add_argument("--cases", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as directory:
        done = examine(Path(directory), cases=asked.cases, seed=asked.seed)
    print(done.stdout + done.stderr)
    sys.exit(done.returncode)


if __name__ == "__main__":
    main()
