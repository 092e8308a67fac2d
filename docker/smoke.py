"""Start the service as the image does, identify a robot of two joints through it, and end it in order."""

import json
import math
import os
import subprocess
import sys
import time
import urllib.request

ADDRESS = f"http://127.0.0.1:{os.environ['VERITORQUE_PORT']}"
START_S = 300.0


def ask(path: str, body: bytes | None = None, **headers: str) -> dict[str, object]:
    """Send a request and give the document of its answer."""
    asked = urllib.request.Request(  # noqa: S310 - our own address
        ADDRESS + path, body, {name.replace("_", "-"): value for name, value in headers.items()}
    )
    with urllib.request.urlopen(asked, timeout=90.0) as answer:  # noqa: S310 - our own address
        document: dict[str, object] = json.loads(answer.read())
        return document


def log() -> bytes:
    """Write the log of two unit inertias that swing without friction or gravity."""
    lines = ["time,q_1,q_2,tau_1,tau_2"]
    for step in range(2000):
        t = step / 200.0
        q = [math.sin(2.0 * t) + 0.3 * math.sin(5.0 * t), math.cos(3.0 * t)]
        ddq = [-4.0 * math.sin(2.0 * t) - 7.5 * math.sin(5.0 * t), -9.0 * math.cos(3.0 * t)]
        noise = [0.01 * math.sin(997.0 * t * t), 0.01 * math.sin(991.0 * t * t)]
        values = [t, *q, *(a + b for a, b in zip(ddq, noise, strict=True))]
        lines.append(",".join(f"{value:.9g}" for value in values))
    return "\n".join(lines).encode()


def main() -> None:
    """Run; a failure ends with a traceback."""
    joint = {"type": "revolute", "alpha": 0.0, "d": 0.0, "r": 0.0, "theta_offset": 0.0}
    robot = {"name": "two", "joints": [joint, joint], "gravity": [0.0, 0.0, -9.81]}
    with subprocess.Popen([sys.executable, "-m", "veritorque", "serve"]) as service:
        try:
            wait()
            with urllib.request.urlopen(ADDRESS + "/static/example-log.csv") as example:  # noqa: S310 - our own
                print(f"the example of the start page has {len(example.read())} bytes")
            named = ask("/v1/robots", json.dumps(robot).encode(), Content_Type="application/json")
            logged = ask("/v1/logs", log(), Content_Type="text/csv")
            asked = {"kind": "identify", "robot": named["id"], "logs": [logged["id"]], "options": {}}
            body = json.dumps(asked).encode()
            job = ask("/v1/jobs", body, Content_Type="application/json", Prefer="wait=60")
            while job["state"] in ("accepted", "running"):
                time.sleep(0.5)
                job = ask(f"/v1/jobs/{job['id']}")
            print(f"the job is {job['state']}: {job.get('problem') or 'no problem'}")
            if job["state"] != "successful":
                sys.exit(1)
        finally:
            service.terminate()
    print(f"the service ended with {service.returncode}")


def wait() -> None:
    """Return when the service answers."""
    deadline = time.monotonic() + START_S
    while True:
        try:
            ask("/healthz")
        except OSError:
            if time.monotonic() > deadline:
                raise
            time.sleep(0.5)
        else:
            return


if __name__ == "__main__":
    main()
