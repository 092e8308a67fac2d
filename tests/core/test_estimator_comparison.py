"""A comparison of estimators: each is what it is alone, and one that fails says why in the same table."""

import csv
import io

import numpy as np
import pytest
from rich.console import Console

from tests.app.planar_arm import columns, description
from veritorque.app.schemas.comparison import ComparisonDocument
from veritorque.app.terminal.output.comparison import print_comparison
from veritorque.core.errors import OptionError
from veritorque.core.estimator_comparison import compare_estimators
from veritorque.core.export.comparison import comparison_csv, comparison_latex
from veritorque.core.identification.comparison_options import ALL, read_estimators, read_options
from veritorque.core.identification.options import parse_options
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.description import robot_from_description
from veritorque.core.study import IdentifyRequest, identify

QUICK = {"bootstrap": {"draws": 0}}


def request(options):
    """Ask about the planar arm."""
    time, position, torque = columns(seconds=10.0, noise=0.05)
    log = log_from_arrays("swing", time, np.round(position, 5), torque)
    return IdentifyRequest(robot_from_description(description()), (log,), {**QUICK, **options})


@pytest.fixture(scope="module")
def compared():
    """Compare all estimators."""
    document = compare_estimators(request({}))
    ComparisonDocument.model_validate(document)
    return document


@pytest.fixture(scope="module")
def with_failure():
    """Compare two estimators, of which the second is simulated with steps that are too long."""
    return compare_estimators(
        request({"compare": ["sdp", "iv"], "simulation": {"bandwidth_hz": 100.0, "substeps": 1}})
    )


def test_all_estimators_are_compared_by_default_and_each_is_what_it_is_alone(compared):
    assert [row["estimator"] for row in compared["compared"]] == [*ALL]
    for row in compared["compared"]:
        alone = identify(request({"estimator": row["estimator"]}))
        for key in ("fit_total_percent", "validation_total_percent", "validation", "estimation"):
            assert row[key] == alone[key], (row["estimator"], key)
        assert row["feasible"] == alone["feasibility"]["feasible"]
        pairs = zip(row["base_parameters"], alone["base_parameters"], strict=True)
        assert all(own[key] == other[key] for own, other in pairs for key in own)
        assert row["cpu_seconds"] > 0.0
        assert len(row["simulated_motion"]["position_rms"]) == 3


def test_an_iteration_says_how_it_ended_and_instruments_how_far_they_lie_from_least_squares(compared):
    rows = {row["estimator"]: row["estimation"] for row in compared["compared"]}
    assert rows["sdp"]["steps"] == []
    assert rows["iv"]["converged"]
    assert rows["iv"]["steps"][-1]["change"] < 1e-3
    assert rows["iv"]["instruments"]["weakest"] > 0.9
    assert rows["didim"]["instruments"] is None
    assert any("standard deviations" in sentence for sentence in rows["iv"]["statements"])


def test_an_estimator_that_fails_is_a_row_with_its_reason(with_failure):
    ComparisonDocument.model_validate(with_failure)
    good, bad = with_failure["compared"]
    assert good["failure"] is None
    assert "diverges" in bad["failure"]["cause"]
    assert bad["failure"]["remedy"]
    assert bad["base_parameters"] == []
    assert bad["feasible"] is None


@pytest.mark.parametrize("names", [["sdp"], ["sdp", "sdp"], ["sdp", "guess"], "sdp", 3, [["sdp"], "iv"]])
def test_a_comparison_of_less_than_two_known_estimators_is_refused(names):
    with pytest.raises(OptionError, match="at least two"):
        read_estimators({"compare": names})


def test_one_estimator_beside_the_compared_ones_is_refused():
    with pytest.raises(OptionError, match="no option estimator"):
        read_estimators({"estimator": "iv"})


@pytest.mark.parametrize(
    "options",
    [
        {"compare": ["ols", "iv"], "robust": 3},
        {"compare": ["ols", "iv"], "robust": True},
        {"compare": ["sdp", "wls"], "simulation": 7},
        {"compare": ["sdp", "wls"], "iteration": {"most": 3}},
        {"compare": ["ols", "wls"], "bounds": {"guess": 1}},
        {"compare": ["sdp", "iv"], "simulation": {"substeps": 0}},
        {"compare": ["sdp", "iv"], "simulation": {"window_seconds": 0.3}},
        {"compare": ["sdp", "oe"], "simulation": {"bandwidth_hz": 3.0}},
    ],
    ids=repr,
)
def test_an_option_that_is_not_valid_or_acts_on_none_of_the_estimators_is_refused(options):
    with pytest.raises(OptionError):
        read_options(options)


@pytest.mark.parametrize("names", [["sdp", "didim"], None])
def test_a_comparison_refuses_flexible_joints_and_names_the_job_that_takes_them(names):
    with pytest.raises(OptionError, match="flexible joints make another") as refused:
        read_options({"compare": names, "flexible_joints": [1]})
    assert "identify" in refused.value.remedy
    assert parse_options({"flexible_joints": [1], "estimator": refused.value.evidence["estimator"]})
    assert read_options({"compare": names, "flexible_joints": []})


@pytest.mark.parametrize(
    "options",
    [
        {"compare": ["ols", "iv"], "robust": False, "bounds": {"plausible": False}},
        {"compare": ["ols", "wls"], "simulation": {}, "iteration": None},
        {"compare": ["iv", "oe"], "simulation": {"window_seconds": 0.3, "bandwidth_hz": 3.0}},
        {"prior": {"entropy": 0.1}, "solver": "cvxpy", "robust": True, "simulation": {"bandwidth_hz": 3.0}},
    ],
    ids=repr,
)
def test_an_option_that_acts_on_some_estimators_is_taken_for_these(options):
    assert read_options(options).estimate.estimator == "sdp"


def test_the_table_of_parameters_leaves_as_csv_and_latex(compared):
    rows = list(csv.DictReader(io.StringIO(comparison_csv(compared).decode())))
    assert [row["name"] for row in rows] == [row["name"] for row in compared["parameters"]]
    own = {row["estimator"]: row["base_parameters"] for row in compared["compared"]}
    assert float(rows[0]["iv_value"]) == own["iv"][0]["value"]
    text = comparison_latex(compared).decode()
    assert text.count(r"\\") == 1 + len(rows) + 2
    assert "e-" not in text.replace(r"\end", "")


def test_an_estimator_that_failed_is_in_no_table_of_parameters(with_failure):
    assert b"iv_value" not in comparison_csv(with_failure)
    assert b"iv" not in comparison_latex(with_failure).splitlines()[2]


def test_the_terminal_prints_errors_parameters_and_reasons(with_failure):
    console = Console(width=200, record=True, file=io.StringIO())
    print_comparison(console, with_failure)
    text = console.export_text()
    assert "torque error" in text
    assert "diverges" in text
    assert all(row["name"] in text for row in with_failure["parameters"])
