"""docs/terminal.md shows commands that run, and the exit codes that there are."""

import json
import re

import pytest

from tests.app.http.test_server import listening_service
from tests.app.stubs import StubExecutor
from tests.app.terminal.conftest import ROOT
from tests.app.terminal.test_examples import called
from tests.core.report.documents import checked, diagnosed
from veritorque.app.json_text import json_bytes
from veritorque.app.kinds.registry import KINDS
from veritorque.app.terminal.backend.local import LocalBackend
from veritorque.app.terminal.main import MODULES
from veritorque.app.terminal.output.exit_codes import Exit

GUIDE = (ROOT / "docs" / "terminal.md").read_text(encoding="utf-8")
LINES = [
    line
    for block in re.findall(r"^```sh\n(.*?)^```$", GUIDE, re.DOTALL | re.MULTILINE)
    for line in block.splitlines()
]


def test_every_command_of_the_guide_runs_in_the_order_of_reading(
    desk, identified, monkeypatch, tmp_path_factory
):
    """What a computation gives is tested elsewhere; here one result stands for all."""
    (desk / "result.json").unlink()
    asked = []

    def computed(_, study, tell, report):
        tell("estimate", 0.5)
        if report is not None:
            report.write_text("drawn")
        asked.append(study)
        made = {"diagnose": diagnosed, "check": checked}
        return identified.read_bytes() if study.kind == "identify" else json_bytes(made[study.kind]())

    monkeypatch.setattr(LocalBackend, "run", computed)
    executor = StubExecutor()
    executor.release.set()
    with listening_service(tmp_path_factory.mktemp("served"), executor) as (_, port):
        for line in LINES:
            ended = called(line, {"http://127.0.0.1:8000": f"http://127.0.0.1:{port}"})
            assert ended.exit_code == 0, (line, ended.output)
            if " > " in line:
                json.loads(ended.stdout)
    assert {"filter": {"cutoff_hz": 8}, "bootstrap": {"draws": 0}} in [study.options for study in asked]
    assert {"report.html", "diagnosis.html", "robot.urdf"} <= {path.name for path in desk.iterdir()}


def test_the_codes_of_the_guide_are_those_that_there_are():
    told = re.findall(r"^\| (\d+) \|", GUIDE, re.MULTILINE)
    assert [int(one) for one in told] == [code.value for code in Exit]


@pytest.mark.parametrize("name", [name for name in MODULES if name not in ("openapi", "version")])
def test_every_command_is_in_the_guide(name):
    assert f"`{name}" in GUIDE


def test_every_kind_of_job_is_explained_where_the_guide_says():
    assert "(api.md#jobrequest)" in GUIDE
    reference = (ROOT / "docs" / "api.md").read_text(encoding="utf-8")
    assert all(f"`{kind.name}`: {kind.words.hint}" in reference for kind in KINDS.values())
