import numpy as np
import pytest

from tests.app.conftest import assert_problem
from tests.app.planar_arm import columns, csv_log
from veritorque.app.schemas.logs import LogTraces

CSV = {"Content-Type": "text/csv"}


@pytest.fixture(scope="module")
def long_log(client):
    """2400 rows of two joints."""
    return client.post("/v1/logs", content=csv_log(), headers=CSV).json()["id"]


def test_a_log_is_looked_at_with_few_points_that_miss_none_of_its_extremes(client, long_log):
    answer = client.get(f"/v1/logs/{long_log}/traces", params={"points": 200})
    seen = LogTraces.model_validate_json(answer.content)
    time, position, torque = columns()
    assert [(trace.channel, trace.joint) for trace in seen.traces] == [
        ("position", 1), ("position", 2), ("torque", 1), ("torque", 2),
    ]  # fmt: skip  # a table
    assert (seen.samples, seen.rows_per_stretch) == (2400, 24)
    assert len(seen.time.values) == 200
    for trace, measured in zip(seen.traces, np.hstack([position, torque]).T, strict=True):
        assert len(trace.values) == 200
        # Single precision has seven digits, and the file was written with seven decimals.
        assert max(trace.values) == pytest.approx(measured.max(), abs=1e-5)
        assert min(trace.values) == pytest.approx(measured.min(), abs=1e-5)
    assert (seen.time.values[0], seen.time.values[-1]) == (time[0], time[-1])


def test_a_short_log_is_shown_row_by_row(client, log_id):
    seen = client.get(f"/v1/logs/{log_id}/traces").json()
    assert (seen["rows_per_stretch"], len(seen["time"]["values"])) == (1, 800)


def test_channels_are_chosen_by_name(client, log_id):
    traces = client.get(f"/v1/logs/{log_id}/traces?channels=torque").json()["traces"]
    assert {(trace["channel"], trace["unit"]) for trace in traces} == {("torque", "N m or N")}
    problem = assert_problem(client.get(f"/v1/logs/{log_id}/traces?channels=velocity"), 422, "request")
    assert problem["evidence"]["known"] == ["position", "torque"]


def test_what_the_controller_asked_for_is_listed_and_shown_with_its_units(client):
    names = ["position_ref_1", "position_ref_2", "command_1", "command_2"]
    lines = csv_log(seconds=4.0).decode().splitlines()
    text = "\n".join([",".join([lines[0], *names]), *(f"{line},0.5,0.6,7,8" for line in lines[1:])])
    log = client.post("/v1/logs", content=text.encode(), headers=CSV).json()
    assert log["channels"] == ["position", "torque", "position_ref", "command"]
    assert log["ignored_columns"] == []
    traces = client.get(f"/v1/logs/{log['id']}/traces?channels=position_ref,command").json()["traces"]
    assert [(trace["channel"], trace["unit"], trace["values"][0]) for trace in traces] == [
        ("position_ref", "rad or m", 0.5), ("position_ref", "rad or m", pytest.approx(0.6, abs=1e-6)),
        ("command", "1", 7.0), ("command", "1", 8.0),
    ]  # fmt: skip  # a table


def test_a_stretch_of_a_log_is_looked_at_row_by_row_where_the_whole_is_thinned(client, long_log):
    query = {"points": 100, "from": 3.0, "to": 3.2, "channels": "torque"}
    seen = client.get(f"/v1/logs/{long_log}/traces", params=query).json()
    time, _, torque = columns()
    inside = slice(599, 642)  # 3.0 to 3.2 s at 200 Hz, and one row more on either side
    assert seen["rows_per_stretch"] == 1
    np.testing.assert_allclose(seen["time"]["values"], time[inside], atol=1e-6)
    for trace, measured in zip(seen["traces"], torque.T, strict=True):
        np.testing.assert_allclose(trace["values"], measured[inside], atol=1e-5)


@pytest.mark.parametrize("stretch", [{"from": 12.5}, {"to": -1}, {"from": 3, "to": 3}, {"from": 4, "to": 3}])
def test_a_stretch_in_which_nothing_was_measured_is_refused(client, long_log, stretch):
    problem = assert_problem(client.get(f"/v1/logs/{long_log}/traces", params=stretch), 422, "option")
    assert (problem["evidence"]["first_s"], problem["evidence"]["last_s"]) == (0.0, 11.995)


@pytest.mark.parametrize("points", [9, 4001, "many"])
def test_the_number_of_points_is_bounded(client, log_id, points):
    assert_problem(client.get(f"/v1/logs/{log_id}/traces", params={"points": points}), 422, "request")


def test_who_has_the_traces_is_told_so_without_the_log_being_read(client, log_id, monkeypatch):
    first = client.get(f"/v1/logs/{log_id}/traces?points=100")
    monkeypatch.setattr("veritorque.app.inspection.inspector.Inspector.trace", None)
    known = {"If-None-Match": first.headers["etag"]}
    assert client.get(f"/v1/logs/{log_id}/traces?points=100", headers=known).status_code == 304


def test_other_traces_have_another_tag(client, log_id):
    tags = {
        client.get(f"/v1/logs/{log_id}/traces?{query}").headers["etag"]
        for query in ("points=100", "points=200", "points=100&channels=torque", "from=1", "to=1")
    }
    assert len(tags) == 5


def test_traces_of_a_log_that_is_not_there_are_not_found(client):
    assert_problem(client.get("/v1/logs/log-none/traces"), 404, "not-found")


def test_a_log_whose_bytes_changed_is_not_drawn(client, long_log):
    summary = client.get(f"/v1/logs/{long_log}").json()
    path = client.app.state.services.store.blobs.path(summary["sha256"])
    content = path.read_bytes()
    path.chmod(0o600)
    path.write_bytes(content.replace(b"0.1", b"0.2", 1))
    try:
        assert_problem(client.get(f"/v1/logs/{long_log}/traces"), 500, "damaged")
    finally:
        path.write_bytes(content)
