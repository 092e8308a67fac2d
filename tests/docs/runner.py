"""Run a page as its reader would: block after block in one shell, against a service that is running.

Shell, Python and C follow each other in one folder, so that a block may use what the one before saved. Every
request has to succeed, unless the page says that it is refused.
"""

import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

from tests.core.log.recordings import write_mcap
from tests.core.log.writers import swing
from tests.docs.blocks import ROOT, Block

RUN = ("bash", "python", "c")
WRITTEN = "http://127.0.0.1:8000"
"""Where the pages say that the service is."""
PRELUDE = """\
set -euo pipefail
curl() { command curl --silent --show-error --write-out '%{stderr}%{http_code}\\n' "$@" 2>> statuses; }
judged() {
  local last; last=$(tail -n 1 statuses)
  if [ -n "$1" ]; then [ "$last" = "$1" ]; else ! grep -qvE '^[123]..$' statuses; fi ||
    { echo "the requests were answered $(tr '\\n' ' ' < statuses)" >&2; exit 1; }
}
"""
_LONGEST_S = 300.0


def run_page(blocks: list[Block], folder: Path, url: str, data: Path) -> None:
    """Run the blocks of a page in a folder, in which lies what the reader's own robot has recorded.

    Raises
    ------
    AssertionError
        If one fails, with where it stands and what it said.
    """
    for name in ("examples", "openapi.json", ".venv"):
        (folder / name).symlink_to(ROOT / name)
    (folder / "run.mcap").symlink_to(_recorded(folder))
    steps = [PRELUDE, *(_step(number, block, folder, url) for number, block in enumerate(blocks))]
    done = subprocess.run(
        ["bash", "-c", "\n".join(steps)],
        cwd=folder,
        env=os.environ | _environment(data),
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


def _environment(data: Path) -> dict[str, str]:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    return {"PATH": path, "PYTHONPATH": str(ROOT), "VERITORQUE_DATA_DIR": str(data)}


def _step(number: int, block: Block, folder: Path, url: str) -> str:
    """Write a block as commands of the shell, between the line that names it and the one that judges it."""
    body = block.body.replace(WRITTEN, url)
    if block.language != "bash":
        file = folder / f"block_{number}.{'py' if block.language == 'python' else 'c'}"
        file.write_text(body, encoding="utf-8")
        body = _started(file)
    return f"echo {shlex.quote(f'in {block}:')} >&2\n: > statuses\n{body}\njudged '{block.status or ''}'"


def _started(file: Path) -> str:
    if file.suffix == ".py":
        return f"python {file.name}"
    if shutil.which("cc") is None:
        return "echo 'no C compiler here' >&2"
    return f"cc -std=c99 -Wall -Werror {file.name} -lm -o {file.stem} && ./{file.stem}"
