"""What jobs need is loaded once, by the server process that they are forked from, and not by each of them."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[3]
ROWS = 1500
CODE = """
import sys
from contextlib import suppress
from importlib import import_module
from pathlib import Path

from veritorque.app.jobs.executors.process_executor import PRELOAD
from veritorque.app.processes.fork_server import READERS

for name in (*PRELOAD, *READERS):
    with suppress(ImportError):
        import_module(name)

from veritorque import builtin_robot, read_log
from veritorque.app.kinds.kind import Inputs
from veritorque.app.kinds.registry import KINDS

folder = Path(sys.argv[1])
inputs = Inputs(builtin_robot("yumi-left"), (read_log(folder / "log.csv"),), {}, traces=folder / "traces")
before = set(sys.modules)
for kind in ("check", "diagnose"):
    KINDS[kind].compute(inputs, lambda *_: None)
print(*(name for name in set(sys.modules) - before if name.startswith(("numba", "scipy", "veritorque"))))
"""


def test_jobs_load_nothing_that_their_server_could_have_loaded(tmp_path):
    lines = (ROOT / "examples" / "yumi" / "hidden_log.csv").read_text(encoding="utf-8").splitlines()
    (tmp_path / "log.csv").write_text("\n".join(lines[:ROWS]) + "\n", encoding="utf-8")
    loaded = subprocess.run(
        [sys.executable, "-c", CODE, str(tmp_path)], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert not loaded.stdout.split()
