"""Hold requests to what can be known before any row of a log is read."""

import math
from dataclasses import replace

import pytest

from tests.core.estimate.worlds import planar_robot
from veritorque.core.dynamics.model import standard_model
from veritorque.core.errors import LogError, OptionError
from veritorque.core.estimate.methods import registry
from veritorque.core.estimate.methods.registry import ESTIMATORS
from veritorque.core.identification.admission import KnownLog, admit
from veritorque.core.identification.options import parse_diagnose_options, parse_options

ROBOT = planar_robot()
LOG = KnownLog("swing.csv", ("position", "torque"), rate_hz=250.0, duration=20.0, samples=5001)
NEARLY = math.nextafter(125.0, 0.0)

FITS = [
    {},
    {"filter": {"cutoff_hz": NEARLY, "position_cutoff_hz": NEARLY}},
    {"filter": {"cutoff_hz": math.nextafter(0.05, 1.0)}},
    {"filter": {"decimation": 250}},
    {"bounds": {"mass": [[2, 1.0, 2.0]], "total_mass": [0.0, 1.0]}},
    {"terms": ["viscous"]},
    {"estimator": "iv"},
]
DOES_NOT_FIT = [
    {"filter": {"cutoff_hz": 125.0}},
    {"filter": {"position_cutoff_hz": 125.0}},
    {"filter": {"cutoff_hz": 0.05}},
    {"filter": {"decimation": 264}},
    {"filter": {"decimation": 251}, "validation": {"blocks": 21}},
    {"bounds": {"mass": [[3, 1.0, 2.0]]}},
    {"bounds": {"mass": [[0, 1.0, 2.0]]}},
    {"bounds": {"centre_box": [[3, 0, 0, 0, 1, 1, 1]]}},
    {"terms": ["viscous"], "bounds": {"total_mass": [1.0, 2.0]}},
    {"terms": ["coupling"]},
    {"validation": {"logs": [1]}},
    {"estimator": "iv", "simulation": {"from": "controller"}},
]


def judged(options, logs):
    admit(options, standard_model(ROBOT, options.terms), logs)


@pytest.mark.parametrize("asked", ["command", "torque_ref"])
def test_a_controller_may_be_simulated_where_the_log_shows_it(asked):
    options = parse_options({"estimator": "iv", "simulation": {"from": "controller"}})
    judged(options, [replace(LOG, channels=("position", "torque", "position_ref", asked))])
    with pytest.raises(OptionError, match="does not show its controller") as refusal:
        judged(options, [replace(LOG, channels=("position", "current", "position_ref"))])
    assert refusal.value.evidence["missing"] == ["torque", "command or torque_ref"]


@pytest.mark.parametrize("options", FITS, ids=repr)
def test_what_may_succeed_is_let_through(options):
    judged(parse_options(options), [LOG])


@pytest.mark.parametrize("options", DOES_NOT_FIT, ids=repr)
def test_what_cannot_succeed_is_refused_with_the_numbers_that_show_it(options):
    with pytest.raises(OptionError) as refusal:
        judged(parse_options(options), [LOG])
    assert refusal.value.evidence
    assert refusal.value.remedy


def test_an_estimator_that_needs_another_channel_is_refused_with_those_that_do_without(monkeypatch):
    needy = replace(ESTIMATORS["wls"], name="needy", needs=("position_ref", "torque"))
    monkeypatch.setattr(registry, "ESTIMATORS", ESTIMATORS | {"needy": needy})
    monkeypatch.setattr("veritorque.core.estimate.options.ESTIMATORS", registry.ESTIMATORS)
    asked = parse_options({"estimator": "needy"})
    with pytest.raises(OptionError) as refusal:
        judged(asked, [LOG])
    assert refusal.value.evidence["missing"] == ["position_ref"]
    assert "sdp" in refusal.value.remedy
    judged(asked, [replace(LOG, channels=(*LOG.channels, "position_ref"))])


def test_every_log_is_held_against_the_options():
    slow = KnownLog("slow.csv", LOG.channels, rate_hz=20.0, duration=20.0, samples=401)
    asked = parse_options({"filter": {"cutoff_hz": 12.0}, "validation": {"logs": [2]}})
    with pytest.raises(OptionError) as refusal:
        judged(asked, [LOG, slow])
    assert (refusal.value.evidence["rate_hz"], refusal.value.evidence["log"]) == (20.0, "slow.csv")


@pytest.mark.parametrize(("samples", "stretches", "fits"), [(200, 1, 1), (1875, 1, 93), (2400, 12, 265)])
def test_a_decimation_may_leave_one_instant_a_block_and_no_less(samples, stretches, fits):
    """By the rows that there are; where steps vary, or stamps are rounded, rate times duration is less."""
    blocks = (samples - stretches) // fits + stretches
    log = KnownLog("s.csv", LOG.channels, 100.0 - 1e-9, 1.99, samples, stretches)
    wanted = {"validation": {"blocks": blocks}}
    judged(parse_options(wanted | {"filter": {"decimation": fits}}), [log])
    with pytest.raises(OptionError, match="fewer instants"):
        judged(parse_options(wanted | {"filter": {"decimation": 2 * fits}}), [log])


def test_the_same_log_twice_is_refused_and_two_of_the_same_name_are_not():
    one, other = replace(LOG, sha256="a"), replace(LOG, sha256="b")
    judged(parse_options({}), [one, other])
    with pytest.raises(LogError, match="more than once"):
        judged(parse_options({}), [one, other, one])


def test_bounds_on_a_model_that_a_reference_decides_are_left_to_it():
    asked = parse_diagnose_options({"reference": "job-1", "bounds": {"mass": [[3, 1.0, 2.0]]}})
    judged(asked, [LOG])


def test_currents_of_a_robot_whose_drives_are_not_described_are_refused():
    with pytest.raises(LogError, match="what torque a current gives"):
        judged(parse_options({}), [replace(LOG, channels=("position", "current"))])
