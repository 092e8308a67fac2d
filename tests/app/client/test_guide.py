"""The code of docs/client.md runs from the first block to the last."""

import re
from pathlib import Path

from tests.app.http.test_server import listening_service
from tests.app.stubs import InlineExecutor

ROOT = Path(__file__).parents[3]
GUIDE = (ROOT / "docs" / "client.md").read_text(encoding="utf-8")


def test_the_code_of_the_guide_runs(tmp_path, monkeypatch, capsys):
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    names = {}
    with listening_service(tmp_path / "data", InlineExecutor()) as (_, port):
        for block in re.findall(r"^```python\n(.*?)^```$", GUIDE, re.DOTALL | re.MULTILINE):
            exec(block.replace("http://127.0.0.1:8000", f"http://127.0.0.1:{port}"), names)  # noqa: S102  # as a reader would
    told = capsys.readouterr().out
    assert names["result"].physically_consistent
    assert (names["mine"].joints, names["robot"].suspicions) == (2, ())
    assert "option the estimator or solver is not known" in told
    assert {"report.html", "robot.urdf", "result.json"} <= {path.name for path in tmp_path.iterdir()}
