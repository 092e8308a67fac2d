"""What is spoilt in described bodies is named and corrected, and nothing else is."""

import re
from dataclasses import replace

import numpy as np
import pytest

from tests.audit.__main__ import counted
from tests.audit.draw import draw
from veritorque.app.schemas.audit import AuditDocument
from veritorque.core.audit.entries import Bodies, Entry
from veritorque.core.export.described import urdf_of_description, urdf_with_bodies
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.urdf.read import robot_from_urdf
from veritorque.core.robot_audit import audit_robot
from veritorque.core.study import IdentifyRequest


@pytest.mark.parametrize("seed", range(3000, 3006))
def test_errors_that_a_log_shows_are_named_and_no_others(seed):
    count = counted(draw(seed))
    assert count.named == count.shown
    assert not count.wrong


@pytest.mark.parametrize("seed", range(3))
def test_a_sound_description_is_contradicted_in_nothing(seed):
    assert counted(draw(seed, errors=0)).wrong == frozenset()


def test_the_corrected_description_is_the_true_one_and_nothing_else_changes():
    case = draw(5000, errors=0)
    spoilt = case.truth.copy()
    spoilt[3] = Bodies(case.truth).changed([(3, 0)], np.array([2.0 * case.truth[3, 9]]))[3]
    robot = replace(case.robot, prior=spoilt)
    document = audit_robot(IdentifyRequest(robot, (case.log,)))
    AuditDocument.model_validate(document)
    (row,) = document["contradicted"]
    assert (row["link"], row["entry"], document["judged"]) == (4, "mass", True)
    assert row["corrected"][0] == pytest.approx(case.truth[3, 9], rel=0.05)
    said = re.search(r"measured ([\d.]+) kg \(p [=<] (\S+), ", row["statement"])
    assert float(said[1]) == pytest.approx(row["corrected"][0], rel=1e-3)
    assert float(said[2]) < 1e-6
    corrected = robot_from_description(document["corrected_robot"]).prior
    assert np.delete(corrected, 3, axis=0) == pytest.approx(np.delete(spoilt, 3, axis=0), rel=1e-6)
    urdf = urdf_of_description(document["corrected_robot"])
    assert robot_from_urdf(urdf).prior[3, 9] == pytest.approx(corrected[3, 9])
    again = urdf_with_bodies(urdf, document["corrected_robot"])
    assert robot_from_urdf(again).prior == pytest.approx(robot_from_urdf(urdf).prior)


def test_a_log_of_another_robot_judges_no_entry():
    case = draw(3)
    time, rng = np.arange(2000) / 100.0, np.random.default_rng(3)
    angles, torque = (np.cumsum(rng.normal(size=(2000, 6)), axis=0) / 50.0 for _ in range(2))
    log = log_from_arrays("another", time, angles, torque)
    document = audit_robot(IdentifyRequest(case.robot, (log,)))
    assert (document["judged"], document["contradicted"], document["corrected_robot"]) == (False, [], None)
    assert document["not_judged_because"]


def test_slopes_are_the_derivatives_of_what_entries_change():
    bodies = Bodies(draw(8).truth)
    numbers = bodies.numbers([Entry(2, kind) for kind in ("mass", "centre", "inertia")])
    at, step = np.linspace(-0.02, 0.03, 10), 1e-6
    for column, slope in enumerate(bodies.slopes(numbers, at).T):
        ahead, behind = (
            bodies.changed(numbers, at + sign * step * np.eye(10)[column]).ravel() for sign in (1, -1)
        )
        assert slope == pytest.approx((ahead - behind) / (2 * step), abs=1e-7)
