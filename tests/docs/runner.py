"""Run a page as its reader would: block after block in one shell, against a service that is running.

Shell, Python and C follow each other in one folder, so that a block may use what the one before saved. Every
request has to succeed, unless the page says that it is refused. A service that a page starts runs until the
page starts another one, or ends.
"""

import os
import shlex
import shutil
import socket
import subprocess
import sys
from pathlib import Path

import numpy as np

from tests.core.log.recordings import write_mcap
from tests.core.log.writers import swing
from tests.docs.blocks import ROOT, Block

RUN = ("bash", "python", "c")
WRITTEN = ("http://127.0.0.1:8000", "http://robotics.example:8000")
"""Where the pages say that the service is."""
DATABASE = "postgresql://veritorque:password@db.example/veritorque"
PRELUDE = """\
set -euo pipefail
running=()
ended() {
  for one in ${running[@]+"${running[@]}"}; do kill -TERM -- "-$one" 2> /dev/null && wait "$one" || true; done
  running=()
}
trap ended EXIT
is_up() {
  for _ in $(seq 600); do
    if bash -c "$1" > /dev/null 2>&1; then return; fi
    kill -0 "${running[-1]}" 2> /dev/null || { echo 'it ended' >&2; return 1; }
    sleep 0.1
  done
  echo "a minute later it is not up: $1" >&2
  return 1
}
curl() { command curl --silent --show-error --write-out '%{stderr}%{http_code}\\n' "$@" 2>> statuses; }
judged() {
  local last; last=$(tail -n 1 statuses)
  if [ -n "$1" ]; then [ "$last" = "$1" ]; else ! grep -qvE '^[123]..$' statuses; fi ||
    { echo "the requests were answered $(tr '\\n' ' ' < statuses)" >&2; exit 1; }
}
"""
_LONGEST_S = 600.0
_SERVE = "serve"
_OURS = {name: value for name, value in os.environ.items() if not name.startswith("VERITORQUE_")}
"""What is set already, but for the service's own settings, which would lead to somebody's data."""


def run_page(blocks: list[Block], folder: Path, url: str, data: Path) -> None:
    """Run the blocks of a page in a folder, in which lies what the reader's own robot has recorded.

    Raises
    ------
    AssertionError
        If one fails, with where it stands and what it said.
    """
    _run(blocks, folder, dict.fromkeys(WRITTEN, url), {"VERITORQUE_DATA_DIR": str(data)})


def run_page_that_serves(blocks: list[Block], folder: Path, database: str) -> None:
    """Run the blocks of a page that starts its own service, with a database in the place of the one it names.

    A service beside which nothing else goes on has no worker, which would load the solver for no job.

    Raises
    ------
    AssertionError
        If one fails, with where it stands and what it said.
    """
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = str(free.getsockname()[1])
    places = dict.fromkeys(WRITTEN, f"http://127.0.0.1:{port}") | {DATABASE: database}
    _run(blocks, folder, places, {"VERITORQUE_PORT": port})


def _run(blocks: list[Block], folder: Path, places: dict[str, str], environment: dict[str, str]) -> None:
    for name in ("examples", "openapi.json", ".venv", "Makefile", "docker"):
        (folder / name).symlink_to(ROOT / name)
    (folder / "run.mcap").symlink_to(_recorded(folder))
    steps = [PRELUDE]
    for number, block in enumerate(blocks):
        beside = next((one for one in blocks[number + 1 :] if one.is_up), None)
        alone = _serves(block) and (beside is None or _serves(beside))
        steps.append(_step(number, block, folder, places, alone=alone))
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "-c", "\n".join(steps)],
        cwd=folder,
        env=_OURS | {"PATH": path, "PYTHONPATH": str(ROOT)} | environment,
        capture_output=True,
        text=True,
        timeout=_LONGEST_S,
        check=False,
    )
    assert done.returncode == 0, f"{done.stderr[-3000:]}\n{done.stdout[-1000:]}"


def _recorded(folder: Path) -> Path:
    """Record a motion of three joints as ROS does."""
    columns = swing(seconds=4.0)
    columns |= {f"qd_{j}": np.gradient(columns[f"q_{j}"], columns["time"]) for j in (1, 2, 3)}
    return write_mcap(folder, columns, {"elbow": 3, "shoulder_lift": 2, "shoulder_pan": 1})


def _step(number: int, block: Block, folder: Path, places: dict[str, str], *, alone: bool) -> str:
    """Write a block as commands of the shell, between the line that names it and the one that judges it."""
    body, up = block.body, block.is_up
    for written, meant in places.items():
        body, up = body.replace(written, meant), up.replace(written, meant)
    if block.language != "bash":
        file = folder / f"block_{number}.{'py' if block.language == 'python' else 'c'}"
        file.write_text(body, encoding="utf-8")
        body = _started(file)
    if up:
        body = _left_running(body, up, f"said_{number}", alone="env VERITORQUE_WORKERS=0 " if alone else "")
    return f"echo {shlex.quote(f'in {block}:')} >&2\n: > statuses\n{body}\njudged '{block.status or ''}'"


def _serves(block: Block) -> bool:
    return bool(block.is_up) and _SERVE in block.body


def _left_running(body: str, is_up: str, said: str, *, alone: str) -> str:
    """Leave its last line running; a service takes the place of what ran before."""
    *before, last = body.strip().split("\n")
    stop = ["ended"] if _SERVE in last else []
    start = [f"setsid {alone}{last} > {said} 2>&1 &", "running+=($!)"]
    look = f"is_up {shlex.quote(is_up)} || {{ cat {said} >&2; exit 1; }}"
    return "\n".join([*before, *stop, *start, look])


def _started(file: Path) -> str:
    if file.suffix == ".py":
        return f"python {file.name}"
    if shutil.which("cc") is None:
        return "echo 'no C compiler here' >&2"
    return f"cc -std=c99 -Wall -Werror {file.name} -lm -o {file.stem} && ./{file.stem}"
