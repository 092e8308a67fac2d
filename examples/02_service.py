"""Identify through a service: upload a log, ask, follow, and take the report and a URDF home.

Start the service with ``python -m veritorque serve``, then run ``python -m examples.02_service``.
"""

import os
from pathlib import Path

from veritorque.app.client.client import Client
from veritorque.app.client.progress import bar

URL = os.environ.get("VERITORQUE_URL", "http://127.0.0.1:8000")
KEY = os.environ.get("VERITORQUE_KEY")
LOG = Path(__file__).parent / "yumi" / "log.csv"


def main() -> None:
    """Upload, ask, wait, fetch."""
    with Client(URL, KEY) as client:
        log = client.upload(LOG)
        print(f"{log.name}: {log.samples} samples at {log.rate_hz:.0f} Hz, {len(log.defects)} defects")

        job = client.identify("yumi-left", log)
        with bar() as tell:
            result = client.wait(job, tell)

        counts = result.document["counts"]
        print(f"{counts['base']} base parameters, {counts['essential']} of them essential")
        Path("report.html").write_bytes(client.report(job))
        Path("robot.urdf").write_bytes(client.export(job, "robot.urdf"))
        print("report.html and robot.urdf are yours")


if __name__ == "__main__":
    main()
