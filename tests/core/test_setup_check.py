"""The set-up check: what it says of robot and logs, of parameters, and of causes that the logs can show."""

import numpy as np
import pytest

from tests.app.planar_arm import columns, description
from veritorque.app.schemas.setup_check import CheckDocument
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.description import robot_from_description
from veritorque.core.setup_check import check_setup
from veritorque.core.study import IdentifyRequest

DELAY_S = 0.01


def checked(change=lambda time, position, torque: (time, position, torque), options=None, **made):
    """Check the planar arm against a log of it, changed."""
    time, position, torque = change(*columns(**{"seconds": 16.0, "noise": 0.05} | made))
    log = log_from_arrays("swing", time, np.round(position, 5), torque)
    document = check_setup(IdentifyRequest(robot_from_description(description()), (log,), options or {}))
    CheckDocument.model_validate(document)
    return document


@pytest.fixture(scope="module")
def sound():
    return checked()


def smallest(document, cause):
    (row,) = [row for row in document["shown"] if row["cause"] == cause]
    return {tuple(size["joints"]): size["value"] for size in row["smallest"]}


def test_a_sound_set_up_agrees_and_every_parameter_has_an_answer(sound):
    assert (sound["agreement"], sound["conflicts"], sound["doubts"]) == ("yes", [], [])
    assert len(sound["identifiable"]) == sound["counts"]["base"]
    for row in sound["identifiable"]:
        assert (row["identifiable"] == "yes") == (row["relative_deviation_percent"] <= 30.0)


def test_exchanged_torques_agree_after_their_correction_and_are_doubtful_without():
    def exchanged(time, position, torque):
        return time, position, torque[:, ::-1]

    found = checked(exchanged)
    assert (found["agreement"], found["conflicts"][0]["conflict"]) == ("after_correction", "channels_swapped")
    assert found["validation_total_percent"] < 10.0
    reported = checked(exchanged, {"conflicts": "report"})
    assert reported["agreement"] == "doubtful"
    assert reported["conflicts"][0]["applied"] is False


def test_what_a_still_joint_leaves_open_needs_motion():
    def one_still(time, position, torque):
        return time, position * [1.0, 0.0], torque * [1.0, 0.0]

    document = checked(one_still)
    answers = {row["name"]: row["identifiable"] for row in document["identifiable"]}
    assert {answers["FV2"], answers["FC2"]} == {"needs_motion"}
    assert answers["FV1"] != "needs_motion"
    assert next(row for row in document["shown"] if row["cause"] == "torque_ripple")["not_on_joints"] == [2]


def test_twice_the_noise_hides_effects_of_twice_the_size(sound):
    noisy = checked(noise=0.1)
    for cause in ("torque_ripple", "encoder_offset", "gravity_misalignment"):
        before, after = smallest(sound, cause), smallest(noisy, cause)
        assert before.keys() == after.keys()
        for joints, value in before.items():
            assert after[joints] / value == pytest.approx(2.0, rel=0.25)


def test_separability_is_symmetric_and_names_what_is_known_of_each_pair(sound):
    table = sound["separable"]
    assert all(table[other][cause] == answer for cause, row in table.items() for other, answer in row.items())
    assert table["encoder_offset"]["kinematic_error"] == "never"
    visible = {row["cause"] for row in sound["shown"] if row["visible"]}
    listed = {frozenset(pair["causes"]) for pair in sound["not_separable"]}
    assert listed == {
        frozenset((cause, other))
        for cause in visible
        for other in visible - {cause}
        if table[cause][other] != "yes"
    }
    assert all(pair["why"] and pair["experiment"] for pair in sound["not_separable"])


def test_slow_motion_cannot_tell_a_delay_from_a_filter_but_friction_from_ripple(sound):
    table = sound["separable"]
    assert table["time_delay"]["torque_filter_lag"] == "needs_motion"
    assert table["friction_load_dependent"]["torque_ripple"] == "yes"


def test_a_log_too_short_for_a_diagnosis_is_checked_all_the_same():
    document = checked(seconds=3.0)
    assert document["agreement"] == "yes"
    assert document["identifiable"]
