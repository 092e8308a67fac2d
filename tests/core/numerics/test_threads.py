"""Test that a study uses one thread of linear algebra, and leaves others their number."""

import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from tests.core.estimate.worlds import log_of, planar_robot, swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.numerics.threads import VARIABLES, on_one_thread
from veritorque.core.study import IdentifyRequest, identify


def blas_threads() -> set[int]:
    """Give how many threads the loaded libraries of linear algebra use."""
    return {pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"}


@pytest.fixture
def undecided(monkeypatch):
    for name in VARIABLES:
        monkeypatch.delenv(name, raising=False)
    with threadpool_limits(2, user_api="blas"):
        assert blas_threads() == {2}
        yield


@pytest.mark.usefixtures("undecided")
def test_a_study_computes_on_one_thread_and_gives_the_others_back():
    model, seen = standard_model(planar_robot()), []
    log = log_of(model, true_parameters(model), swing(len(model.robot.joints), seed=1))
    options = {"bootstrap": {"draws": 0}}
    identify(IdentifyRequest(model.robot, (log,), options), lambda _stage, _done: seen.append(blas_threads()))
    assert seen
    assert all(threads == {1} for threads in seen)
    assert blas_threads() == {2}


@pytest.mark.parametrize("name", VARIABLES)
@pytest.mark.usefixtures("undecided")
def test_who_runs_the_process_may_decide_otherwise(monkeypatch, name):
    monkeypatch.setenv(name, "2")
    with on_one_thread():
        assert blas_threads() == {2}
