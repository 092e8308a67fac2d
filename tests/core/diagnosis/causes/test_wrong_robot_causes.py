"""Causes in the robot's description or its surroundings: their sites and admissible estimates."""

from dataclasses import replace

import numpy as np
import pytest

from tests.tools import random_robot
from veritorque.core.diagnosis.causes.backlash import Backlash
from veritorque.core.diagnosis.causes.encoder_eccentricity import EncoderEccentricity
from veritorque.core.diagnosis.causes.external_contact import ExternalContact
from veritorque.core.diagnosis.causes.gravity_misalignment import GravityMisalignment
from veritorque.core.diagnosis.causes.kinematic_error import KinematicError
from veritorque.core.diagnosis.causes.payload_change import PayloadChange
from veritorque.core.diagnosis.causes.protocol import FittedCause
from veritorque.core.diagnosis.causes.shared.harmonics import amplitude_and_angle
from veritorque.core.diagnosis.causes.shared.own_joint import end_links, revolute_joints
from veritorque.core.dynamics.terms.external_contact import WRENCH

SPANS = {"start_1": 3.0, "end_1": 3.5, "start_2": 8.0, "end_2": 8.4}


def solved(values, scalars, *, deviation=0.01, site=(6,)) -> FittedCause:
    values = np.asarray(values, dtype=float)
    return FittedCause(site, values, deviation**2 * np.eye(len(values)), scalars, {})


def test_a_contact_whose_moment_no_lever_explains_is_not_admissible():
    cause, wrench = ExternalContact(), np.zeros((2, len(WRENCH)))
    wrench[:, 0] = 10.0
    assert cause.admissible(solved(wrench.ravel(), SPANS))
    wrench[1, 3] = 20.0
    assert not cause.admissible(solved(wrench.ravel(), SPANS))


def test_a_contact_reports_every_force_and_first_the_most_certain_one():
    wrench = np.zeros((2, len(WRENCH)))
    wrench[:, :3] = [[3.0, 4.0, 0.0], [0.0, 0.0, 2.0]]
    pushes = solved(wrench.ravel(), SPANS)
    pushes.covariance[:3, :3] *= 100.0
    found = {one.name: one.value for one in ExternalContact().quantities(pushes)}
    assert found == pytest.approx({"force": 2.0, "force_1": 5.0, "force_2": 2.0, **SPANS})


def test_a_removed_body_has_a_negative_mass_and_its_centre_where_it_was():
    load = -2.0 * np.array([0, 0, 0, 0, 0, 0, 0.1, 0.2, -0.3, 1.0])
    quantities = PayloadChange().quantities(solved(load, {"time": 4.0}))
    found = {one.name: one.value for one in quantities}
    assert found == pytest.approx({"mass": -2.0, "com_x": 0.1, "com_y": 0.2, "com_z": -0.3, "time": 4.0})
    assert "removed from the link of joint 6: 2" in PayloadChange().statement(solved(load, {"time": 4.0}))


@pytest.mark.parametrize(("error", "told"), [(-0.02, "smaller by 0.02 "), (0.02, "larger by 0.02 ")])
def test_an_entry_that_is_too_large_has_to_be_smaller_and_one_that_is_too_small_larger(error, told):
    assert told in KinematicError().statement(solved([error], {"entry": 0.0}))


def test_the_deviation_of_a_mass_centre_is_that_of_a_ratio():
    rng = np.random.default_rng(1)
    load = np.array([0, 0, 0, 0, 0, 0, 0.2, 0.0, 0.0, 2.0])
    drawn = load + 0.01 * rng.normal(size=(20_000, 10))
    scatter = np.std(drawn[:, 6] / drawn[:, 9])
    stated = next(
        one for one in PayloadChange().quantities(solved(load, {"time": 0.0})) if one.name == "com_x"
    )
    assert stated.standard_deviation == pytest.approx(scatter, rel=0.03)


def test_amplitude_and_angle_scatter_as_stated():
    rng = np.random.default_rng(2)
    mean, covariance = np.array([1.0, -2.0]), np.array([[4e-3, 1e-3], [1e-3, 1e-3]])
    drawn = rng.multivariate_normal(mean, covariance, 20_000)
    (size, wide), (angle, angle_deviation) = amplitude_and_angle(mean, covariance)
    assert (size, angle) == pytest.approx((np.hypot(1.0, 2.0), np.arctan2(-2.0, 1.0)))
    assert wide == pytest.approx(np.std(np.hypot(*drawn.T)), rel=0.03)
    assert angle_deviation == pytest.approx(np.std(np.arctan2(drawn[:, 1], drawn[:, 0])), rel=0.03)


def test_the_phase_of_an_eccentric_disc_is_that_of_a_sine():
    found = EncoderEccentricity().quantities(solved(0.02 * np.array([np.cos(1.2), np.sin(1.2)]), {}))
    assert [one.value for one in found] == pytest.approx([0.02, 1.2])


def test_a_tilt_that_is_not_observable_is_not_reported():
    open_axis = FittedCause((), np.array([0.0, 0.02]), np.diag([1e10, 1e-6]), {}, {})
    cause = GravityMisalignment()
    assert [one.name for one in cause.quantities(open_axis)] == ["tilt_y"]
    assert "x axis" not in cause.statement(open_axis)


def test_backlash_of_another_width_than_the_crossings_were_computed_for_is_not_admissible():
    assert Backlash().admissible(solved([1e-3], {"around": 2e-3}))
    assert not Backlash().admissible(solved([1e-3], {"around": 2e-2}))
    assert not Backlash().admissible(solved([-1e-3], {"around": 1e-3}))


def test_a_tree_has_several_ends_and_a_prismatic_joint_no_angle():
    rng = np.random.default_rng(3)
    robot = random_robot(rng, 4, prismatic=0.0)
    links = list(robot.links)
    links[3] = replace(links[3], antecedent=2, kind="prismatic")
    forked = replace(robot, links=tuple(links))
    assert end_links(robot) == {4: 4}
    assert end_links(forked) == {3: 3, 4: 4}
    assert revolute_joints(forked) == (1, 2, 3)
