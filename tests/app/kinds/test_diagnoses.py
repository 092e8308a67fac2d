"""Diagnoses by the real science: how they go on, and how they end where there is nothing to diagnose from."""

import time

import numpy as np
import pytest
from starlette.testclient import TestClient

from tests.app.conftest import assert_problem, service
from tests.app.planar_arm import columns, description
from tests.app.stubs import InlineExecutor
from veritorque.app.main import create_app
from veritorque.app.settings import Settings

CSV = {"Content-Type": "text/csv"}


@pytest.fixture(scope="module")
def client(tmp_path_factory):
    """A service which computes with the real science, in the tests' own process."""
    with service(tmp_path_factory.mktemp("data"), InlineExecutor()) as client:
        yield client


def measured(change=lambda time, position, torque: (time, position, torque), **options):
    """Write a log of the planar arm, changed; positions come in steps of 1e-5 rad, as from an encoder."""
    time, position, torque = columns(**{"seconds": 20.0, "noise": 0.05} | options)
    table = np.column_stack(change(time, np.round(position, 5), torque))
    rows = [",".join(f"{value:.6f}" for value in row) for row in table]
    return "\n".join(["time,q_1,q_2,tau_1,tau_2", *rows]).encode()


def asked(client, log, options=None, **changes):
    robot = client.post("/v1/robots", json=description()).json()["id"]
    identity = client.post("/v1/logs", content=log, headers=CSV).json()["id"]
    return {"kind": "diagnose", "robot": robot, "logs": [identity], "options": options or {}} | changes


def diagnosed(client, log, options=None):
    """Give the job when it has ended, and its result where it has one."""
    body = asked(client, log, {"bootstrap": {"draws": 0}} | (options or {}))
    answer = client.post("/v1/jobs", json=body, headers={"Prefer": "wait=60"})
    assert answer.status_code == 200, answer.text
    job = answer.json()
    return job, client.get(job["links"]["results"]).json() if job["state"] == "successful" else None


def refused(client, log, options=None):
    """Give the problem of a job that has failed for a reason that the client can mend."""
    job, _ = diagnosed(client, log, options)
    assert job["state"] == "failed"
    problem = job["problem"]
    assert problem["status"] == 422, problem
    assert problem["cause"]
    assert problem["evidence"]
    assert problem["remedy"]
    return problem


def parked(joint):
    def change(time, position, torque):
        position[:, joint] = 0.3
        return time, position, torque

    return change


def at_rest(time, position, torque):
    noise = np.random.default_rng(1)
    still = 0.3 + 1e-5 * np.round(noise.standard_normal(position.shape))
    return time, still, 3.0 + 0.05 * noise.standard_normal(torque.shape)


def one_slow_way(time, position, torque):
    """Move so slowly that neither joint turns round within the log."""
    noise = np.random.default_rng(2)
    way = np.column_stack([0.3 * np.sin(0.05 * time), 0.2 * (1.0 - np.cos(0.05 * time))])
    torque = 3.0 + way + 0.05 * noise.standard_normal(torque.shape)
    return time, np.round(way, 5), torque


TOO_LITTLE = {"at rest": measured(at_rest), "25 samples a second": measured(seconds=30.0, rate_hz=25.0)}


@pytest.mark.parametrize("log", TOO_LITTLE.values(), ids=TOO_LITTLE.keys())
def test_a_log_with_too_little_motion_to_hold_any_out_is_refused_with_what_would_do(client, log):
    problem = refused(client, log)
    assert problem["type"] == "urn:veritorque:problem:excitation"
    evidence = problem["evidence"]
    assert all(had < needed for had, needed in zip(evidence["instants"], evidence["needed"], strict=True))
    assert "at least ten seconds in which every joint moves, at 100 Hz or more" in problem["remedy"]


def test_a_log_of_few_rows_is_diagnosed_and_what_it_cannot_tell_is_unknown(client):
    _, result = diagnosed(client, measured(seconds=3.0))
    assert result["diagnosis"]["findings"] == []
    left = result["diagnosis"]["unexplained"]
    assert None in left["predictable_residual_fraction"]
    assert [None, None] in left["interval_95"]


def test_what_a_parked_joint_could_not_show_is_listed_with_the_motion_that_would(client):
    job, result = diagnosed(client, measured(parked(1), seconds=12.0))
    diagnosis = result["diagnosis"]
    assert diagnosis["findings"] == []
    hidden = {one["cause"]: one for one in diagnosis["not_identifiable"] if 2 in one["joints"]}
    assert {"friction_stribeck", "friction_load_dependent", "torque_ripple", "torque_gain"} <= set(hidden)
    assert all(one["why"] and one["separating_experiment"] for one in hidden.values())
    assert diagnosis["unexplained"]["predictable_residual_fraction"][1] is None
    report = client.get(job["links"]["report"]).text
    assert "No statement is possible on joint 2: there is hardly any motion." in report


def test_a_motion_in_which_no_joint_turns_round_is_diagnosed(client):
    job, result = diagnosed(client, measured(one_slow_way))
    assert job["state"] == "successful", job["problem"]
    assert "friction_presliding" in [one["cause"] for one in result["diagnosis"]["not_identifiable"]]


REFUSED_AT_ONCE = {
    "nothing held out": {"validation": {"fraction": 0.0}},
    "less than a block held out": {"validation": {"fraction": 0.05, "blocks": 4}},
    "everything held out": {"validation": {"fraction": 1.0}},
    "a negative part held out": {"validation": {"fraction": -0.1}},
    "one block": {"validation": {"blocks": 1}},
    "a thousand million blocks": {"validation": {"blocks": 10**9}},
    "words for a number": {"validation": {"fraction": "much"}},
    "an unknown option": {"causes": ["torque_ripple"]},
    "an unknown term": {"terms": ["magic"]},
    "a million draws": {"bootstrap": {"draws": 10**6}},
    "a mass below zero": {"bounds": {"mass": [[1, -5.0, -2.0]]}},
    "a cut-off below zero": {"filter": {"cutoff_hz": -3.0}},
    "a cut-off above half the rate": {"filter": {"cutoff_hz": 1e6}},
    "a cut-off slower than the log is long": {"filter": {"cutoff_hz": 0.01}},
    "one instant in a block's worth of samples": {"filter": {"decimation": 1000}},
    "the only log held out": {"validation": {"logs": [1]}},
    "a log held out that is not there": {"validation": {"logs": [2]}},
    "a bound on a link that is not there": {"bounds": {"mass": [[3, 1.0, 2.0]]}},
}


@pytest.mark.parametrize("options", REFUSED_AT_ONCE.values(), ids=REFUSED_AT_ONCE.keys())
def test_options_that_make_no_sense_are_refused_before_anything_is_computed(client, options):
    answer = client.post("/v1/jobs", json=asked(client, measured(), options))
    problem = assert_problem(answer, 422, "option")
    assert problem["evidence"]
    assert problem["remedy"]


def test_a_log_that_is_not_finite_or_of_another_robot_is_never_diagnosed(client):
    def broken(time, position, torque):
        position[7:, 0] = np.nan
        return time, position, torque

    answer = client.post("/v1/logs", content=measured(broken), headers=CSV)
    assert_problem(answer, 422, "log")
    body = asked(client, measured(), robot="yumi-left")
    problem = assert_problem(client.post("/v1/jobs", json=body), 422, "log")
    assert (problem["evidence"]["log_joints"], problem["evidence"]["robot_joints"]) == (2, 7)


def test_a_log_that_says_nothing_of_the_robot_is_not_given_a_cause(client):
    noise = np.random.default_rng(3)
    _, result = diagnosed(
        client, measured(lambda t, q, tau: (t, q, 100.0 * noise.standard_normal(tau.shape)))
    )
    assert result["diagnosis"]["findings"] == []
    assert result["diagnosis"]["verdict"] == "unexplained"  # the model leaves all of the torque, and says so


def test_a_diagnosis_tells_its_stages_in_order_with_a_fraction_that_never_falls(client):
    def rippled(time, position, torque):
        torque[:, 1] += 0.3 * np.cos(7.0 * position[:, 1] + 0.4)
        return time, position, torque

    _, result = diagnosed(client, measured(rippled, noise=0.1))
    assert [one["cause"] for one in result["diagnosis"]["findings"]] == ["torque_ripple"]
    stages = [stage for stage, _ in client.executor.told]
    once = [
        "condition",
        "search",
        "compare alternatives",
        "predict the residual",
        "prepare figures",
        "simulate",
    ]
    assert [stage for stage in dict.fromkeys(stages) if stage in once] == once
    fractions = [fraction for _, fraction in client.executor.told]
    assert fractions == sorted(fractions)
    assert 0.0 < fractions[0] < fractions[-1] < 1.0


@pytest.mark.slow
def test_a_diagnosis_that_is_dismissed_while_it_searches_makes_room_for_the_next_at_once(tmp_path):
    def until(path, reached, seconds=60.0):
        deadline = time.monotonic() + seconds
        while not reached(job := client.get(path).json()) and time.monotonic() < deadline:
            time.sleep(0.02)
        assert reached(job), job

    with TestClient(create_app(Settings(data_dir=tmp_path))) as client:
        body = asked(client, measured(seconds=60.0))
        first = client.post("/v1/jobs", json=body).headers["location"]
        until(first, lambda job: job["progress"]["stage"] == "search")
        assert client.delete(first).json()["state"] == "dismissed"
        second = client.post("/v1/jobs", json=body).headers["location"]
        until(second, lambda job: job["state"] == "running", seconds=5.0)
        assert_problem(client.get(f"{first}/results"), 409, "job-dismissed")
        assert client.delete(second).json()["state"] == "dismissed"
