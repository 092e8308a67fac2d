"""Ask what has changed since an earlier log of the same arm, with everything over again from the samples."""

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tests.plant.again import arm_of, logged, with_friction, with_gravity
from tests.plant.effects.drive import TorqueGain
from tests.plant.effects.surroundings import PayloadChange
from veritorque.core import study
from veritorque.core.document.model.reading import identified_model, identified_robot
from veritorque.core.document.model.reference import reference_from_document
from veritorque.core.errors import OptionError, RobotError
from veritorque.core.robot.frames import rotation_x, rotation_y
from veritorque.core.robot.model import RobotModel
from veritorque.core.study import IdentifyRequest

NAME, SEED = "planar-3", 1
SECONDS = {NAME: 12.0, "yumi-left": 8.0}
LOAD = {"mass": 0.3, "com_x": 0.05, "com_y": 0.03}
RUBBED = {"delta_viscous": 0.13, "delta_coulomb": 0.4}
TILT = {"tilt_x": -0.03, "tilt_y": 0.02}
FEW = {"bootstrap": {"draws": 0}}


@cache
def log_with(change: str, name: str = NAME):
    arm = arm_of(name, SEED)
    effects = {
        "payload": (PayloadChange((arm.joints,), com_z=0.0, time=-1.0, **LOAD),),
        "gain": (TorqueGain((2,), 0.05),),
        "all gains": tuple(TorqueGain((joint,), 0.05) for joint in range(1, arm.joints + 1)),
    }.get(change, ())
    if change == "friction":
        arm = with_friction(arm, 2, viscous=RUBBED["delta_viscous"], coulomb=RUBBED["delta_coulomb"])
    if change == "tilt":
        arm = with_gravity(arm, rotation_y(TILT["tilt_y"]) @ rotation_x(TILT["tilt_x"]))
    seeds = ("nothing before", "nothing", "payload", "gain", "all gains", "friction", "tilt")
    return logged(arm, 100 + seeds.index(change), *effects, duration=SECONDS[name])


@cache
def earlier(name: str = NAME, **options: object):
    request = IdentifyRequest(arm_of(name, SEED).robot, (log_with("nothing before", name),), FEW | options)
    return json.loads(json.dumps(study.identify(request)))


@cache
def compared(change: str, name: str = NAME):
    """Give the document of a diagnosis against the earlier log."""
    options = FEW | {"reference": "job-1"}
    return study.diagnose(
        IdentifyRequest(arm_of(name, SEED).robot, (log_with(change, name),), options, earlier(name))
    )


def described(prior: np.ndarray) -> RobotModel:
    return replace(arm_of(NAME, SEED).robot, prior=prior)


def against_description(prior: np.ndarray):
    request = IdentifyRequest(described(prior), (log_with("nothing"),), FEW | {"reference": "prior"})
    return study.diagnose(request)["diagnosis"]


def assert_sizes(finding, truth):
    """See every hidden number within three deviations of what was found."""
    found = {one["name"]: one for one in finding["parameters"]}
    for name, value in truth.items():
        assert abs(found[name]["value"] - value) < 3.0 * found[name]["standard_deviation"], found[name]


def the_finding(document):
    (one,) = document["diagnosis"]["findings"]
    assert document["diagnosis"]["verdict"] == "causes_found"
    assert one["gain"]["interval_95"][0] > 0.0
    return one


@pytest.mark.slow
def test_nothing_has_changed_where_nothing_has():
    diagnosis = compared("nothing")["diagnosis"]
    assert (diagnosis["verdict"], diagnosis["findings"]) == ("nothing_found", [])


@pytest.mark.slow
def test_a_body_on_the_last_link_is_named_with_its_mass_and_centre():
    found = the_finding(compared("payload"))
    assert (found["cause"], found["joints"], found["cure"]) == ("payload_change", [3], "robot")
    assert_sizes(found, LOAD)
    assert "since the reference" in found["statement"]
    sizes = {one["name"]: one["value"] for one in found["parameters"]}
    assert "time" not in sizes
    payload = found["payload"]
    assert (payload["link"], payload["removed"], payload["flange"]) == (3, False, None)
    assert payload["mass"] == pytest.approx(sizes["mass"])
    centre = payload["frames"][0]["center_of_mass"][:2]
    assert centre == pytest.approx([sizes["com_x"], sizes["com_y"]])


@pytest.mark.slow
def test_friction_that_has_grown_on_one_joint_is_named_with_its_two_parts():
    found = the_finding(compared("friction"))
    assert (found["cause"], found["joints"]) == ("friction_change", [2])
    assert_sizes(found, RUBBED)


@pytest.mark.slow
def test_a_channel_whose_scale_has_changed_is_named_with_its_error():
    found = the_finding(compared("gain"))
    assert (found["cause"], found["joints"]) == ("torque_gain", [2])
    assert_sizes(found, {"relative_error": 0.05})


@pytest.mark.slow
def test_all_channels_whose_scale_has_changed_alike_are_one_thing():
    found = the_finding(compared("all gains"))
    assert (found["cause"], found["joints"]) == ("torque_gain", [1, 2, 3])
    assert_sizes(found, {"relative_error": 0.05})


@pytest.mark.slow
def test_a_base_that_was_tilted_is_named_with_its_two_angles():
    found = the_finding(compared("tilt", "yumi-left"))
    assert found["cause"] == "gravity_misalignment"
    assert_sizes(found, TILT)


@pytest.mark.slow
@pytest.mark.parametrize("change", ["payload", "friction", "all gains"])
def test_what_a_new_identification_absorbs_is_not_seen_without_a_reference(change):
    request = IdentifyRequest(arm_of(NAME, SEED).robot, (log_with(change),), FEW)
    diagnosis = study.diagnose(request)["diagnosis"]
    changes = {"payload_change", "link_parameters", "friction_change", "torque_gain"}
    assert not changes & {one["cause"] for one in diagnosis["findings"]}
    assert diagnosis["reference"] is None


def test_before_is_the_reference_as_it_is_and_after_is_as_good_as_a_new_identification():
    document = compared("payload")
    diagnosis = document["diagnosis"]
    sides = [diagnosis["before"]["validation"], diagnosis["after"]["validation"], document["validation"]]
    before, after, anew = ([row["nrmse_of_rms_percent"] for row in side] for side in sides)
    assert min(old / new for old, new in zip(before, anew, strict=True)) > 2.0
    np.testing.assert_allclose(after, anew, rtol=0.1)
    assert all(one["interval_95"][0] > 0.0 for one in diagnosis["gain"])
    assert min(diagnosis["simulation"]["improvement_total_percent"]) > 30.0


def test_the_reference_is_told_beside_what_was_identified_anew():
    diagnosis, old = compared("friction")["diagnosis"], earlier()
    told = diagnosis["reference"]
    assert (told["name"], told["left_open"], told["worse_than_nothing"]) == ("job-1", [], [])
    rows = {one["name"]: one for one in told["base_parameters"]}
    assert [one["reference"] for one in rows.values()] == [one["value"] for one in old["base_parameters"]]
    assert rows["FC2"]["identified"] - rows["FC2"]["reference"] == pytest.approx(0.4, abs=0.05)


def test_the_extended_model_keeps_to_the_reference_where_nothing_has_changed():
    after = {one["name"]: one for one in compared("friction")["diagnosis"]["after"]["base_parameters"]}
    old = {one["name"]: one["value"] for one in earlier()["base_parameters"]}
    change = after["delta_coulomb2"]
    assert after["FC2"]["value"] - change["value"] == pytest.approx(old["FC2"], rel=0.02)
    assert change["new"]
    assert change["part_of"] == ["FC2"]
    assert change["value"] == pytest.approx(0.4, abs=0.05)


def test_a_friction_that_changed_is_one_number_in_document_table_and_file():
    document = json.loads(json.dumps(compared("friction")))
    told = {row["name"]: row["value"] for row in document["base_parameters"]}
    assert told["FC2"] == pytest.approx(identified_robot(document).values["FC2"], rel=1e-9)
    assert told["FC2"] == {row["name"]: row["value"] for row in document["standard_parameters"]}["FC2"]
    # The same by the extended model of model.json, in which the change is a term of its own.
    whole = identified_model(document).values
    assert told["FC2"] == pytest.approx(whole["FC2"] + whole["delta_coulomb2"], rel=1e-9)
    rows = {row["name"]: row for row in document["base_parameters"]}
    # A sum of two numbers that are known together is not better known than the friction measured alone.
    anew = {row["name"]: row for row in document["plain"]["base_parameters"]}
    assert rows["FC2"]["standard_deviation"] < 1.05 * anew["FC2"]["standard_deviation"]


def test_a_result_with_findings_is_a_reference_by_its_plain_model():
    document = json.loads(json.dumps(compared("friction")))
    reference = reference_from_document(document, arm_of(NAME, SEED).robot, "job-2")
    assert list(reference.base.names) == [row["name"] for row in document["plain"]["base_parameters"]]


def test_a_description_with_true_bodies_is_compared_with_and_its_friction_is_filled_in():
    diagnosis = against_description(arm_of(NAME, SEED).bodies)
    assert (diagnosis["verdict"], diagnosis["findings"]) == ("nothing_found", [])
    assert {"FV1", "FC2", "OFF3", "IA2"} <= set(diagnosis["reference"]["left_open"])
    assert max(row["nrmse_of_rms_percent"] for row in diagnosis["before"]["validation"]) < 5.0


@pytest.mark.slow
def test_a_description_with_one_wrong_link_has_that_link_named():
    bodies = arm_of(NAME, SEED).bodies.copy()
    bodies[1, 6:9] *= 1.3
    (found,) = against_description(bodies)["findings"]
    assert (found["cause"], found["joints"]) == ("link_parameters", [2])
    assert_sizes(found, {"delta_MX": arm_of(NAME, SEED).bodies[1, 6] - bodies[1, 6]})


@pytest.mark.slow
def test_a_reference_that_does_not_fit_at_all_is_doubted_and_not_refused():
    bodies = 4.0 * arm_of(NAME, SEED).bodies
    document = study.diagnose(
        IdentifyRequest(described(bodies), (log_with("nothing"),), FEW | {"reference": "prior"})
    )
    joints = document["diagnosis"]["reference"]["worse_than_nothing"]
    assert joints
    assert any(f"torque of joint {joints[0]}" in one for one in document["doubts"])


def test_a_description_without_bodies_cannot_be_compared_with():
    request = IdentifyRequest(arm_of(NAME, SEED).robot, (log_with("nothing"),), {"reference": "prior"})
    with pytest.raises(RobotError, match="no prior"):
        study.check_reference(request)


def changed_robot(what: str) -> RobotModel:
    robot = arm_of(NAME, SEED).robot
    if what == "gravity":
        return replace(robot, gravity=-robot.gravity)
    if what == "friction":
        return replace(robot, joints=(replace(robot.joints[0], friction=("viscous",)), *robot.joints[1:]))
    if what == "link 2":
        moved = replace(robot.links[1], translation=robot.links[1].translation + 0.01, row=None)
        return replace(robot, links=(robot.links[0], moved, *robot.links[2:]))
    return arm_of("planar-2", SEED).robot


@pytest.mark.parametrize("what", ["gravity", "friction", "link 2", "joints"])
def test_the_result_of_another_robot_is_refused_with_what_differs(what):
    request = IdentifyRequest(changed_robot(what), (), {"reference": "job-1"}, earlier())
    with pytest.raises(OptionError, match="another robot") as caught:
        study.check_reference(request)
    assert any(what in one for one in caught.value.evidence["differ"])


@pytest.mark.parametrize("decided", [{"terms": ["rigid_body"]}, {"smooth_coulomb": True}])
def test_what_the_reference_decides_cannot_be_asked_for_beside_it(decided):
    options = {"reference": "job-1"} | decided
    request = IdentifyRequest(arm_of(NAME, SEED).robot, (), options, earlier())
    with pytest.raises(OptionError, match="decides"):
        study.check_reference(request)


def test_a_result_that_does_not_tell_its_precision_is_refused():
    old = json.loads(json.dumps(earlier()))
    del old["precision"]["information_factor"]
    request = IdentifyRequest(arm_of(NAME, SEED).robot, (), {"reference": "job-1"}, old)
    with pytest.raises(OptionError, match="how well its parameters are known"):
        study.check_reference(request)


@pytest.mark.slow
def test_a_smoothed_model_is_compared_with_by_the_same_smoothing():
    old = earlier(smooth_coulomb=True)
    options = FEW | {"reference": "job-1"}
    request = IdentifyRequest(arm_of(NAME, SEED).robot, (log_with("nothing"),), options, old)
    document = study.diagnose(request)
    assert document["diagnosis"]["findings"] == []
    assert document["coulomb_smoothing_widths"] == old["coulomb_smoothing_widths"]
