"""Whatever takes a URDF takes the part of it that is meant, and where down is: here and on a service."""

import json

import pytest

from tests.app.http.test_server import listening_service
from tests.app.planar_arm import GRAVITY, LENGTH, csv_log, description
from tests.app.stubs import StubExecutor
from tests.app.terminal.conftest import run
from tests.core.report.documents import diagnosed, identified
from veritorque.app.jobs import compute as computing
from veritorque.app.terminal.output.exit_codes import Exit

MEANT = ("--base-link", "wall", "--tip-link", "fore", f"--gravity=0,{-GRAVITY},0")
CELL = f"""<robot name="planar arm in a cell">
  <link name="cell"/><link name="wall"/><link name="upper"/><link name="fore"/><link name="finger"/>
  <joint name="mount" type="fixed"><parent link="cell"/><child link="wall"/>
    <origin xyz="1 2 3" rpy="1.5 0.4 0"/></joint>
  <joint name="shoulder" type="continuous"><parent link="wall"/><child link="upper"/>
    <axis xyz="0 0 1"/></joint>
  <joint name="elbow" type="continuous"><parent link="upper"/><child link="fore"/><axis xyz="0 0 1"/>
    <origin xyz="{LENGTH} 0 0"/></joint>
  <joint name="grip" type="prismatic"><parent link="fore"/><child link="finger"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="0.05" effort="20" velocity="0.1"/></joint>
</robot>"""
"""The planar arm on a wall, with a gripper that the log does not hold."""
LOOKS = ("show", "check", "base-parameters")
STUDIES = {"identify": identified, "diagnose": diagnosed}


@pytest.fixture
def cell(desk):
    (desk / "arm.urdf").write_text(CELL)
    (desk / "swing.csv").write_bytes(csv_log())
    return desk


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    executor = StubExecutor()
    executor.release.set()
    with listening_service(tmp_path_factory.mktemp("data"), executor) as (_, port):
        yield executor, ("--url", f"http://127.0.0.1:{port}")


def placed(robot):
    """What moves where: the joints' frames and gravity."""
    frames = [(row["rotation"], row["translation"]) for row in robot["joints"]]
    return frames, robot["gravity"]


def test_the_part_that_is_meant_is_the_arm_of_the_textbook(cell):
    shown = json.loads(run("robots", "show", "arm.urdf", *MEANT, "--json").stdout)
    level = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    assert placed(shown) == ([(level, [0.0] * 3), (level, [LENGTH, 0.0, 0.0])], [0.0, -GRAVITY, 0.0])
    (cell / "arm.json").write_text(json.dumps(description()))
    rows = [
        run("robots", "base-parameters", *given).stdout.splitlines()[1:]
        for given in (("arm.json",), ("arm.urdf", *MEANT))
    ]
    bodies = [[row for row in found if row.startswith(("ZZ", "MX", "MY"))] for found in rows]
    assert [len(found) for found in bodies] == [6, 6]


@pytest.mark.parametrize("where", ["here", "there"])
@pytest.mark.parametrize("command", LOOKS)
def test_every_look_at_a_urdf_looks_at_the_part_that_is_meant(cell, served, command, where):
    url = served[1] if where == "there" else ()
    whole, part = (run("robots", command, "arm.urdf", *asked, *url) for asked in ((), MEANT))
    assert (whole.exit_code, part.exit_code) == (Exit.DONE, Exit.DONE), part.output
    if command != "base-parameters":
        assert ("3 joints" in whole.stdout, "2 joints" in part.stdout) == (True, True)
    assert whole.stdout != part.stdout


@pytest.mark.parametrize("kind", STUDIES)
def test_every_study_computes_with_the_part_that_is_meant(cell, served, monkeypatch, kind):
    asked = (kind, "arm.urdf", "swing.csv")
    refused = run(*asked)
    assert (refused.exit_code, "different numbers of joints" in refused.stderr) == (Exit.INPUT, True)
    seen = []
    monkeypatch.setattr(computing, "compute", lambda one, *_: seen.append(one.robot) or STUDIES[kind]())
    executor, url = served
    for where in ((), url):
        ended = run(*asked, *MEANT, *where, "--json")
        assert ended.exit_code == Exit.DONE, ended.output
    shown = json.loads(run("robots", "show", "arm.urdf", *MEANT, "--json").stdout)
    assert [*seen, executor.computations[-1].robot] == [shown, shown]


@pytest.mark.parametrize("command", [*(("robots", look) for look in LOOKS), *((kind,) for kind in STUDIES)])
def test_what_is_no_urdf_and_what_is_no_link_of_it_are_refused_alike_everywhere(cell, command):
    logs = () if command[0] == "robots" else ("swing.csv",)
    for asked, said in (
        (("yumi-left", *logs, "--tip-link", "fore"), "is no URDF"),
        (("arm.urdf", *logs, "--tip-link", "hand"), "a chosen link does not exist"),
        (("arm.urdf", *logs, "--gravity", "down"), "gravity is not three numbers"),
    ):
        ended = run(*command, *asked)
        assert (ended.exit_code, said in ended.stderr) == (Exit.INPUT, True), ended.output
