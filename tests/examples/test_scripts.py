"""The numbered scripts and the notebook are what a newcomer copies: each of them runs."""

import json
import re
import runpy
from pathlib import Path

import pytest

from tests.app.http.test_server import listening_service
from tests.app.stubs import InlineExecutor, StubExecutor
from tests.core.report.documents import diagnosed
from veritorque.app.jobs.computation import Finished
from veritorque.app.json_text import json_bytes

EXAMPLES = Path(__file__).parents[2] / "examples"
NOTEBOOK = json.loads((EXAMPLES / "notebook.ipynb").read_text(encoding="utf-8"))


def ran(number, capsys):
    """Run a script in this process, in the folder that is current; gives what it prints."""
    (script,) = EXAMPLES.glob(f"{number}_*.py")
    runpy.run_path(str(script), run_name="__main__")
    return capsys.readouterr().out


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "examples").symlink_to(EXAMPLES)
    return tmp_path


@pytest.fixture(scope="module")
def science(tmp_path_factory):
    """A service with the real science; gives its address."""
    with listening_service(tmp_path_factory.mktemp("data"), InlineExecutor()) as (_, port):
        yield f"http://127.0.0.1:{port}"


def test_a_result_of_files_is_simulated_in_mujoco(folder, capsys):
    told = ran("01", capsys)
    assert "physically consistent" in told
    errors = [float(one) for one in re.findall(r"^ +\d  (\d+\.\d+)$", told, re.MULTILINE)]
    assert len(errors) == 7
    assert max(errors) < 3.0  # the 1.2 to 1.7 % of rms of docs/accuracy.md, with room for another machine
    swung = ran("06", capsys)
    # bodies.json weighs 9.5 kg; what is identified is one robot of many with the same base parameters
    assert swung.startswith("7 joints")
    assert swung.count(" deg/s") == 7


def test_the_service_gives_report_and_urdf(folder, capsys, monkeypatch, science):
    monkeypatch.setenv("VERITORQUE_URL", science)
    told = ran("02", capsys)
    assert "log.csv: 7500 samples at 250 Hz, 0 defects" in told
    assert "71 base parameters" in told
    assert "<html" in (folder / "report.html").read_text(encoding="utf-8")
    assert "<robot" in (folder / "robot.urdf").read_text(encoding="utf-8")


def test_a_robot_of_ones_own_is_described_without_a_warning(folder, capsys):
    from veritorque import robot_from_description

    told = ran("03", capsys)
    assert "rarely meant" not in told
    # every joint's viscous friction, Coulomb friction and offset are identifiable; one sum stands on a line
    (sums,) = re.findall(r"a motion tells (\d+) sums", told)
    assert len(re.findall(r"^(?:FV|FC|OFF)\d ", told, re.MULTILINE)) == 9
    assert int(sums) == len(re.findall(r"^[A-Z]+\d +\S", told, re.MULTILINE))
    described = json.loads((folder / "my-arm.json").read_text(encoding="utf-8"))
    assert len(robot_from_description(described).links) == 3


def test_findings_are_read_with_sizes_alternatives_and_gain(folder, capsys, monkeypatch, tmp_path_factory):
    """The science of a diagnosis takes its time and is tested with the demonstration."""
    executor = StubExecutor(Finished(json_bytes(diagnosed())))
    executor.release.set()
    with listening_service(tmp_path_factory.mktemp("data"), executor) as (_, port):
        monkeypatch.setenv("VERITORQUE_URL", f"http://127.0.0.1:{port}")
        told = ran("04", capsys)
    assert "verdict: causes_found" in told
    assert "load_coefficient: 0.07 ± 0.002" in told
    assert "undecided with: torque_gain" in told
    assert "takes 33 % of the error away" in told
    assert (folder / "diagnosis.html").stat().st_size > 10_000


def test_two_logs_of_which_one_hides_something_differ_beyond_chance(folder, capsys):
    told = ran("05", capsys)
    differing = int(told.split()[0])
    assert 0 < differing < 40
    assert len(told.splitlines()) == 6


def test_the_notebook_runs_from_the_first_cell_to_the_last(folder, capsys, monkeypatch, science):
    monkeypatch.setenv("VERITORQUE_URL", science)
    names = {}
    for cell in NOTEBOOK["cells"]:
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), cell["id"], "exec"), names)  # noqa: S102  # a notebook's way
    assert names["result"].physically_consistent
    assert (names["parameters"].shape[0], "of 71" in capsys.readouterr().out) == (71, True)
    assert (folder / "robot.urdf").exists()


def test_the_notebook_is_kept_without_outputs():
    code = [cell for cell in NOTEBOOK["cells"] if cell["cell_type"] == "code"]
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in code)
