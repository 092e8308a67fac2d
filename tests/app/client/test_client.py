import json
import sys
import threading
from http.server import BaseHTTPRequestHandler, HTTPServer

import numpy as np
import pandas as pd
import pytest

from tests.app.http.test_server import listening_service
from tests.app.planar_arm import columns, csv_log, description
from tests.app.stubs import RESULT, StubExecutor, failing
from veritorque.app.client.client import Client
from veritorque.app.client.errors import NoAnswerError, NoResultError, RefusedError
from veritorque.app.client.result import Result
from veritorque.core.errors import LogError, OptionError, RobotError


@pytest.fixture(scope="module")
def swing(tmp_path_factory):
    path = tmp_path_factory.mktemp("logs") / "swing.csv"
    path.write_bytes(csv_log(seconds=4.0))
    return path


@pytest.fixture
def busy(tmp_path):
    """A service whose jobs do not end by themselves; gives its executor and a client."""
    executor = StubExecutor()
    with listening_service(tmp_path, executor) as (_, port), Client(f"http://127.0.0.1:{port}") as client:
        yield executor, client


def test_a_file_a_frame_and_arrays_are_the_same_log(lab, swing):
    time, position, torque = columns(seconds=4.0)
    named = {"time": time, "q_1": position[:, 0], "q_2": position[:, 1]}
    frame = pd.DataFrame(named | {"tau_1": torque[:, 0], "tau_2": torque[:, 1]})
    arrays = {"time": time, "q": position, "tau": torque}
    logs = [lab.upload(one) for one in (swing, str(swing), frame, arrays)]
    assert [log.name for log in logs] == ["swing.csv", "swing.csv", "log", "log"]
    assert len({(log.samples, log.joints, log.channels, round(log.rate_hz, 6)) for log in logs}) == 1
    assert logs[0].id == logs[1].id


def test_columns_of_other_names_and_units_are_mapped(lab):
    time, position, torque = columns(seconds=4.0)
    mapping = {
        "time": {"column": "t", "unit": "ms"},
        "position": {"columns": ["a_1", "a_2"], "unit": "deg"},
        "torque": {"columns": ["m_1", "m_2"], "unit": "N m"},
    }
    log = lab.upload(
        {"t": 1e3 * time, "a": np.degrees(position), "m": torque}, name="degrees", mapping=mapping
    )
    assert (log.name, log.rate_hz) == ("degrees", pytest.approx(200.0))


def test_defects_are_typed(lab):
    time, position, torque = columns(seconds=6.0)
    still = np.where(time[:, None] > 3.0, position[time <= 3.0][-1], position)
    log = lab.upload({"time": time, "q": still, "tau": torque})
    standstill = next(defect for defect in log.defects if defect.kind == "standstill")
    (interval,) = standstill.intervals
    assert interval == pytest.approx((3.0, time[-1]), abs=0.1)


@pytest.mark.parametrize(("log", "said"), [(7, "int is not a log"), ("absent.csv", "cannot be read")])
def test_what_is_no_log_is_refused_before_anything_is_sent(lab, log, said):
    with pytest.raises(LogError, match=said):
        lab.upload(log)


def test_robots_are_listed_described_and_found_again(lab, tmp_path):
    (tmp_path / "arm.json").write_text(json.dumps(description()))
    robot = lab.add_robot(tmp_path / "arm.json")
    assert lab.add_robot(description()) == robot == lab.robot(robot.id)
    assert (robot.name, robot.joints, robot.built_in) == ("planar arm", 2, False)
    assert {"yumi-left", "yumi-right", "yumi", robot.id} <= {one.id for one in lab.robots()}
    with pytest.raises(RobotError, match="cannot be read"):
        lab.add_robot("absent.json")


def test_a_study_goes_from_a_file_to_typed_tables(lab, swing, tmp_path):
    told = []
    job = lab.identify(description(), swing, {"bootstrap": {"draws": 0}})
    result = lab.wait(job, lambda *step: told.append(step))
    assert told[-1] == ("successful", 1.0)
    assert result.document == RESULT == lab.result(job).document == json.loads(lab.result_bytes(job.id))
    assert result.base.name == ("ZZR1",)
    assert (result.base.value[0], result.base.standard_deviation[0]) == (0.5, 0.01)
    assert np.array_equal(result.validation.nrmse_of_rms_percent, [2.0, 4.0])
    assert (result.physically_consistent, result.verdict, result.findings) == (True, None, ())
    assert lab.job(job.id) in lab.jobs()
    assert b"<html" in lab.report(job)
    assert lab.export(job, "parameters.csv").startswith(b"name,")
    result.save(tmp_path / "result.json")
    assert type(result).load(tmp_path / "result.json").document == RESULT


def test_rows_become_a_data_frame_or_say_what_is_missing(lab, swing, monkeypatch):
    result = lab.wait(lab.identify(description(), swing))
    frame = result.fit.frame()
    assert list(frame.columns)[:2] == ["joint", "rms_torque"]
    assert frame.shape[0] == len(result.fit) == 2
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(OptionError, match="pandas") as caught:
        result.base.frame()
    assert "notebook" in caught.value.remedy


def test_a_dismissed_job_has_no_result_and_its_computation_ends(busy, swing):
    executor, client = busy
    job = client.identify(description(), swing)

    def dismiss(stage, _fraction):
        if stage == "estimate":
            client.cancel(job)

    with pytest.raises(NoResultError, match="dismissed") as caught:
        client.wait(job, dismiss)
    assert caught.value.kind == "dismissed"
    assert executor.stopped.wait(5.0)
    client.cancel(job)
    assert client.job(job.id).state == "dismissed"


def test_a_failed_job_says_cause_evidence_and_remedy(tmp_path, swing):
    executor = failing()
    executor.release.set()
    with (
        listening_service(tmp_path, executor) as (_, port),
        Client(f"http://127.0.0.1:{port}") as client,
        pytest.raises(NoResultError) as caught,
    ):
        client.wait(client.identify(description(), swing))
    error = caught.value
    assert (error.kind, error.cause, error.evidence, error.remedy) == (
        "excitation",
        "the motion is too slow",
        {"speed": 0.01},
        "move faster",
    )


def test_a_refusal_carries_the_problem(lab, swing):
    with pytest.raises(RefusedError, match="is not known") as caught:
        lab.identify(description(), swing, {"estimator": "guess"})
    assert (caught.value.kind, "sdp" in str(caught.value.evidence)) == ("option", True)
    with pytest.raises(RefusedError) as caught:
        lab.wait("no-such-job")
    assert caught.value.kind == "not-found"


class Foreign(BaseHTTPRequestHandler):
    """A server that is not the service: a page for everything, and a memory of the last key."""

    heard = ""

    def do_GET(self):
        type(self).heard = self.headers.get("Authorization", "")
        self.send_response(200)
        self.end_headers()
        self.wfile.write(b"<html>welcome")

    def log_message(self, *_):
        pass


def test_what_is_not_the_service_is_told_from_one_that_is_silent(lab):
    server = HTTPServer(("127.0.0.1", 0), Foreign)
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
    thread.start()
    with Client(f"http://127.0.0.1:{server.server_port}", key="the-secret") as client:
        with pytest.raises(NoAnswerError, match="does not answer as the service"):
            client.robots()
        assert (client.is_alive(), Foreign.heard) == (False, "Bearer the-secret")
    server.shutdown()
    thread.join()
    server.server_close()
    with Client(f"http://127.0.0.1:{server.server_port}") as client:
        assert not client.is_alive()
        with pytest.raises(NoAnswerError, match="does not answer") as caught:
            client.jobs()
    assert "veritorque serve" in caught.value.remedy
    assert lab.is_alive()


@pytest.mark.parametrize("url", ["nowhere", "file:///etc", "http://", "http://host:port", "http://[::1"])
def test_what_is_no_address_is_refused(url):
    with pytest.raises(NoAnswerError, match="not the address of a service"):
        Client(url)


@pytest.mark.parametrize("key", ["schlüssel", "two\nlines"])
def test_what_no_key_can_be_is_refused_before_it_is_sent(key):
    with pytest.raises(NoAnswerError, match="the key holds characters"):
        Client("http://127.0.0.1:1", key)


@pytest.mark.parametrize("name", ["a b", "a?b", "ä#1"])
def test_an_id_is_one_step_of_the_path_whatever_it_holds(lab, name):
    with pytest.raises(RefusedError) as refused:
        lab.robot(name)
    assert refused.value.evidence["robot"] == name


def test_a_check_gives_its_document_and_what_is_no_identified_robot_is_refused_as_a_result(lab, swing):
    assert lab.check(description(), swing) == json.loads(json.dumps(RESULT))
    with pytest.raises(OptionError, match="holds no identified robot"):
        Result.from_document({"kind": "check"})
