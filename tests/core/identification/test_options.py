"""Hold the options to strictness: what is known is read, everything else is refused with what is known."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from veritorque.core.errors import OptionError
from veritorque.core.estimate.constraints import CentreBox, CentreEllipsoid, LinkSize
from veritorque.core.identification.options import parse_diagnose_options, parse_options

SECTIONS = ("filter", "validation", "bootstrap", "bounds", "prior", "simulation", "iteration")


def test_no_options_give_the_defaults():
    for nothing in (None, {}):
        options = parse_options(nothing)
        assert options.estimate.estimator == "sdp"
        assert options.filter.median_order == 5
        assert options.filter.cutoff_hz is None
        assert (options.validation.fraction, options.validation.blocks) == (0.2, 20)
        assert options.terms is None
        assert not options.essential


def test_every_option_is_read():
    options = parse_options(
        {
            "estimator": "sdp",
            "solver": "cvxpy",
            "robust": True,
            "essential": True,
            "smooth_coulomb": True,
            "terms": ["rigid_body", "viscous"],
            "filter": {
                "median_order": 7,
                "cutoff_hz": 12,
                "position_cutoff_hz": 60.0,
                "order": 4,
                "decimation": 3,
            },
            "validation": {"fraction": 0.25, "blocks": 8, "logs": [2]},
            "bootstrap": {"draws": 7, "seed": 3},
            "prior": {"pull": 1e-4, "entropy": 2},
            "bounds": {
                "margin": 1e-3,
                "plausible": False,
                "size": [[2, 0, 0, 0.1, 0.5]],
                "mass": [[1, 0.5, 2]],
                "total_mass": [1, 9],
                "centre_box": [[1, -1, -1, -1, 1, 1, 1]],
                "centre_ellipsoid": [[2, 0, 0, 0, 0.1, 0.2, 0.3]],
            },
        }
    )
    assert (options.estimate.estimator, options.estimate.solver, options.estimate.robust) == (
        "sdp",
        "cvxpy",
        True,
    )
    assert (options.estimate.pull, options.estimate.entropy) == (1e-4, 2.0)
    assert options.terms == ("rigid_body", "viscous")
    assert vars(options.filter) == {
        "median_order": 7,
        "cutoff_hz": 12.0,
        "position_cutoff_hz": 60.0,
        "order": 4,
        "decimation": 3,
    }
    assert (options.validation.fraction, options.validation.blocks, options.validation.logs) == (
        0.25,
        8,
        (2,),
    )
    assert (options.bootstrap.draws, options.bootstrap.seed) == (7, 3)
    bounds = options.estimate.bounds
    assert (bounds.mass, bounds.total_mass, bounds.margin) == (((1, 0.5, 2.0),), (1.0, 9.0), 1e-3)
    assert (bounds.plausible, bounds.sizes) == (False, (LinkSize(2, (0.0, 0.0, 0.1), 0.5),))
    assert bounds.centres == (
        CentreBox(1, (-1.0, -1.0, -1.0), (1.0, 1.0, 1.0)),
        CentreEllipsoid(2, (0.0, 0.0, 0.0), (0.1, 0.2, 0.3)),
    )


@given(name=st.text(min_size=1, max_size=12), section=st.sampled_from([None, *SECTIONS]))
def test_an_unknown_option_is_refused_with_the_list_of_the_known_ones(name, section):
    known = parse_options_known(section)
    if name in known:
        return
    with pytest.raises(OptionError) as refusal:
        parse_options({name: 1} if section is None else {section: {name: 1}})
    assert refusal.value.evidence["known"] == known
    assert any(name in one for one in refusal.value.evidence["unknown"])


def parse_options_known(section: str | None) -> list[str]:
    with pytest.raises(OptionError) as refusal:
        parse_options({"no such option": 1} if section is None else {section: {"no such option": 1}})
    return refusal.value.evidence["known"]


WRONG = [
    {"estimator": "lms"},
    {"estimator": 3},
    {"solver": "ipopt"},
    {"essential": 1},
    {"essential": "true"},
    {"robust": "yes"},
    {"terms": []},
    {"terms": "viscous"},
    {"terms": ["stribeck"]},
    {"terms": [["viscous"]]},
    {"terms": [{"name": "viscous"}]},
    {"filter": 10},
    {"filter": {"cutoff_hz": "10"}},
    {"filter": {"cutoff_hz": True}},
    {"filter": {"cutoff_hz": math.nan}},
    {"filter": {"cutoff_hz": math.inf}},
    {"filter": {"cutoff_hz": 0.0}},
    {"filter": {"cutoff_hz": -3.0}},
    {"filter": {"position_cutoff_hz": -1e-9}},
    {"filter": {"order": 0}},
    {"filter": {"order": 13}},
    {"filter": {"order": 10**400}},
    {"filter": {"median_order": 4}},
    {"filter": {"median_order": 2.0}},
    {"filter": {"decimation": 0}},
    {"validation": {"fraction": 0.9}},
    {"validation": {"blocks": 1}},
    {"validation": {"logs": 1}},
    {"validation": {"logs": ["1"]}},
    {"validation": {"logs": [True]}},
    {"bootstrap": {"draws": -1}},
    {"bootstrap": {"draws": 10_000}},
    {"bootstrap": {"seed": -1}},
    {"bootstrap": {"draws": 1.5}},
    {"prior": {"pull": 0}},
    {"prior": {"pull": math.nan}},
    {"prior": {"entropy": -1}},
    {"prior": {"entropy": 1}},
    {"estimator": "wls", "bounds": {"total_mass": [1, 9]}},
    {"estimator": "ols", "robust": True},
    {"terms": []},
    {"terms": ["viscous", "viscous"]},
    {"bounds": {"margin": math.inf}},
    {"bounds": {"margin": -1.0}},
    {"bounds": {"mass": [[1, 2, 1]]}},
    {"bounds": {"mass": [[1, -2, 1]]}},
    {"bounds": {"mass": [[1, 0, 0]]}},
    {"bounds": {"mass": [[1, 1, 2], [1, 3, 4]]}},
    {"bounds": {"mass": [[1, 1, 2], [2, 3, 4]], "total_mass": [1, 3.5]}},
    {"bounds": {"total_mass": [0, 0]}},
    {"bounds": {"mass": [1, 2, 3]}},
    {"bounds": {"mass": [[1.5, 1, 2]]}},
    {"bounds": {"mass": [[1, 1, math.nan]]}},
    {"bounds": {"total_mass": [2, 1]}},
    {"bounds": {"total_mass": [1]}},
    {"bounds": {"total_mass": [[1, 2]]}},
    {"bounds": {"size": [[1, 0, 0, 0, 0]]}},
    {"bounds": {"size": [[1, 0, 0, 0]]}},
    {"bounds": {"plausible": 1}},
    {"bounds": {"exempt": [1]}},
    {"bounds": {"centre_box": [[1, 1, 1, 1, 0, 0, 0]]}},
    {"bounds": {"centre_ellipsoid": [[1, 0, 0, 0, 0, 1, 1]]}},
    {"simulation": {"bandwidth_hz": 2.0}},
    {"iteration": {"most": 3}},
    {"estimator": "iv", "robust": True},
    {"estimator": "iv", "simulation": {"from": 3}},
    {"estimator": "iv", "simulation": {"from": "guess"}},
    {"estimator": "iv", "simulation": {"source": "replay"}},
    {"estimator": "iv", "simulation": {"bandwidth_hz": 0.0}},
    {"estimator": "iv", "simulation": {"substeps": 0}},
    {"estimator": "iv", "simulation": {"substeps": True}},
    {"estimator": "iv", "simulation": {"substeps": 101}},
    {"estimator": "iv", "iteration": {"most": 0}},
    {"estimator": "iv", "iteration": {"tolerance": 0.0}},
]


@pytest.mark.parametrize("options", WRONG, ids=repr)
def test_an_option_of_the_wrong_kind_is_refused_with_a_remedy(options):
    with pytest.raises(OptionError) as refusal:
        parse_options(options)
    assert refusal.value.evidence
    assert refusal.value.remedy


def test_the_options_that_were_given_are_kept_for_provenance_and_not_changed():
    given_options = {"filter": {"cutoff_hz": 10}, "bootstrap": {"draws": 3}}
    assert parse_options(given_options).given == {"filter": {"cutoff_hz": 10}, "bootstrap": {"draws": 3}}
    assert given_options == {"filter": {"cutoff_hz": 10}, "bootstrap": {"draws": 3}}


@pytest.mark.parametrize("validation", [{"fraction": 0.0}, {"fraction": 0.1, "blocks": 4}])
def test_a_diagnosis_that_would_hold_nothing_out_is_refused_where_an_identification_is_not(validation):
    assert parse_options({"validation": validation}).validation.chosen(1) == frozenset()
    with pytest.raises(OptionError, match="held-out data"):
        parse_diagnose_options({"validation": validation})


@pytest.mark.parametrize("estimator", ["iv", "didim", "clie", "cloe"])
def test_a_diagnosis_by_an_estimator_that_simulates_is_refused_where_an_identification_is_not(estimator):
    asked = {
        "estimator": estimator,
        "simulation": {"from": "controller", "substeps": 3},
        "iteration": {"most": 4},
    }
    options = parse_options(asked).estimate
    assert options.simulates_controllers
    assert (options.simulation.substeps, options.iteration.most) == (3, 4)
    with pytest.raises(OptionError, match="cannot be fitted by"):
        parse_diagnose_options({"estimator": estimator})


def test_what_would_not_act_on_free_motion_is_refused_and_windows_where_no_motion_is_free():
    assert parse_options({"estimator": "oe", "simulation": {"window_seconds": 0.3}})
    for estimator, simulation, named in (
        ("oe", {"from": "controller"}, "simulation.from"),
        ("oe", {"bandwidth_hz": 3.0}, "simulation.bandwidth_hz"),
        ("clie", {"window_seconds": 0.3}, "simulation.window_seconds"),
    ):
        with pytest.raises(OptionError, match=named):
            parse_options({"estimator": estimator, "simulation": simulation})


def test_lists_of_whole_numbers_may_be_written_with_decimal_points():
    asked = {"estimator": "didim", "flexible_joints": [1.0, 3], "validation": {"logs": [2.0]}}
    options = parse_options(asked)
    assert (options.estimate.flexible_joints, options.validation.logs) == ((1, 3), (2,))


def test_a_diagnosis_may_hold_whole_logs_out_instead_of_blocks():
    held = parse_diagnose_options({"validation": {"fraction": 0.0, "logs": [2]}}).validation
    assert {log for log, _ in held.chosen(2)} == {1}


@pytest.mark.parametrize(
    ("asked", "helps"),
    [
        ({"estimator": "wls", "bounds": {"total_mass": [1.0, 2.0]}}, True),
        ({"estimator": "iv", "robust": True}, True),
        ({"estimator": "tls", "iteration": {"most": 3}}, False),
        ({"estimator": "oe", "simulation": {"bandwidth_hz": 3.0}}, False),
        ({"estimator": "iv", "kalman": {"drift": 0.1}}, False),
    ],
)
def test_least_squares_is_recommended_only_where_it_takes_the_option(asked, helps):
    with pytest.raises(OptionError, match="no effect") as refusal:
        parse_options(asked)
    assert ("sdp" in refusal.value.remedy) == helps
    if helps:
        assert parse_options(asked | {"estimator": "sdp"})
