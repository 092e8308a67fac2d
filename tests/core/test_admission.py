"""Hold requests to what can be known before any row of a log is read."""

import math

import pytest

from core.admission import KnownLog, admit
from core.errors import LogError, OptionError
from core.options import parse_diagnose_options, parse_options
from tests.core.estimate.worlds import planar_robot

ROBOT = planar_robot()
LOG = KnownLog("swing.csv", ("position", "torque"), rate_hz=250.0, duration=20.0)
NEARLY = math.nextafter(125.0, 0.0)

FITS = [
    {},
    {"filter": {"cutoff_hz": NEARLY, "position_cutoff_hz": NEARLY}},
    {"filter": {"cutoff_hz": math.nextafter(0.05, 1.0)}},
    {"filter": {"decimation": 250}},
    {"bounds": {"mass": [[2, 1.0, 2.0]], "total_mass": [0.0, 1.0]}},
    {"terms": ["viscous"]},
]
DOES_NOT_FIT = [
    {"filter": {"cutoff_hz": 125.0}},
    {"filter": {"position_cutoff_hz": 125.0}},
    {"filter": {"cutoff_hz": 0.05}},
    {"filter": {"decimation": 264}},
    {"bounds": {"mass": [[3, 1.0, 2.0]]}},
    {"bounds": {"mass": [[0, 1.0, 2.0]]}},
    {"bounds": {"centre_box": [[3, 0, 0, 0, 1, 1, 1]]}},
    {"terms": ["viscous"], "bounds": {"total_mass": [1.0, 2.0]}},
    {"terms": ["coupling"]},
    {"validation": {"logs": [1]}},
]


@pytest.mark.parametrize("options", FITS, ids=repr)
def test_what_may_succeed_is_let_through(options):
    admit(parse_options(options), ROBOT, [LOG])


@pytest.mark.parametrize("options", DOES_NOT_FIT, ids=repr)
def test_what_cannot_succeed_is_refused_with_the_numbers_that_show_it(options):
    with pytest.raises(OptionError) as refusal:
        admit(parse_options(options), ROBOT, [LOG])
    assert refusal.value.evidence
    assert refusal.value.remedy


def test_every_log_is_held_against_the_options():
    slow = KnownLog("slow.csv", LOG.channels, rate_hz=20.0, duration=20.0)
    asked = parse_options({"filter": {"cutoff_hz": 12.0}, "validation": {"logs": [2]}})
    with pytest.raises(OptionError) as refusal:
        admit(asked, ROBOT, [LOG, slow])
    assert refusal.value.evidence["rate_hz"] == 20.0


def test_bounds_on_a_model_that_a_reference_decides_are_left_to_it():
    asked = parse_diagnose_options({"reference": "job-1", "bounds": {"mass": [[3, 1.0, 2.0]]}})
    admit(asked, ROBOT, [LOG])


def test_currents_of_a_robot_whose_drives_are_not_described_are_refused():
    with pytest.raises(LogError, match="what torque a current gives"):
        admit(parse_options({}), ROBOT, [KnownLog("amperes.csv", ("position", "current"), 250.0, 20.0)])
