"""Ask a service what the simulation of a robot gets wrong, and read findings, alternatives and gain.

The log hides two effects that the description does not tell of. Start the service with
``python -m veritorque serve``, then run ``python -m examples.04_diagnose``; it takes ten seconds or so.
"""

import os
from pathlib import Path

from veritorque.app.client.client import Client
from veritorque.app.client.progress import bar

URL = os.environ.get("VERITORQUE_URL", "http://127.0.0.1:8000")
KEY = os.environ.get("VERITORQUE_KEY")
LOG = Path(__file__).parent / "yumi" / "hidden_log.csv"


def main() -> None:
    """Ask, wait, read."""
    with Client(URL, KEY) as client:
        job = client.diagnose("yumi-left", LOG)
        with bar() as tell:
            result = client.wait(job, tell)
        Path("diagnosis.html").write_bytes(client.report(job))

    print(f"verdict: {result.verdict}")
    for finding in result.findings:
        print(f"{finding.statement} (confidence {100 * finding.confidence:.0f} %)")
        for name, (value, deviation) in finding.parameters.items():
            print(f"   {name}: {value:.4g} ± {deviation:.2g}")
        if finding.ambiguous_with:
            print(f"   undecided with: {', '.join(finding.ambiguous_with)}")
        if finding.improvement_percent is not None:
            print(f"   takes {finding.improvement_percent:.0f} % of the error away")


if __name__ == "__main__":
    main()
