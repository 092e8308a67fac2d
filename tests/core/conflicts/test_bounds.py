"""Hold the bounds by which hypotheses are sorted: what is shared between set-ups changes none of them."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.estimate.worlds import swing, true_parameters
from veritorque.core.conflicts.family import family
from veritorque.core.conflicts.reduced import stacked
from veritorque.core.conflicts.samples import sampled
from veritorque.core.conflicts.setup import Setup
from veritorque.core.conflicts.trial import Trials
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.terms.kinematic_error import with_entry
from veritorque.core.log.columns.assignment import Assignment, Channels, assigned
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.description import robot_from_description
from veritorque.core.signals.recipe import FilterOptions
from veritorque.core.signals.several import condition_all
from veritorque.core.validation.holdout import HoldOut

PLAIN = Assignment.as_measured(3)
MIXED = Assignment(
    PLAIN.position.scaled(-1.0, 1).exchanged(0, 2), PLAIN.torque.exchanged(0, 1).scaled(-3.0, 0), 1.25
)
"""Other positions, torques and stamps than measured."""


def trials(log, robot):
    """Take the samples of a log."""
    return Trials(sampled(condition_all((log,), robot, FilterOptions(), blocks=20), HoldOut().chosen(1)))


@pytest.fixture(scope="module")
def arm():
    """Give three joints, the second with a length of zero, and a noisy log of them."""
    row = {"type": "revolute", "theta_offset": 0.1}
    rows = [
        {**row, "alpha": 0.0, "d": 0.0, "r": 0.3},
        {**row, "alpha": -np.pi / 2, "d": 0.0, "r": 0.0},
        {**row, "alpha": 0.3, "d": 0.4, "r": 0.1},
    ]
    robot = robot_from_description({"name": "arm", "joints": rows})
    state = swing(3, seed=5)
    torque = standard_model(robot).torque(true_parameters(standard_model(robot), seed=3), state)
    torque += 0.1 * np.std(torque, axis=0) * np.random.default_rng(8).normal(size=torque.shape)
    return robot, log_from_arrays("swing", np.arange(len(torque)) / 100.0, state.position, torque)


def bound(setup, some):
    """Bound a set-up by itself."""
    return float(some.equations(setup).reduced.bound)


@pytest.mark.parametrize("assignment", [PLAIN, MIXED])
def test_the_bound_under_any_gravity_is_that_of_the_robot_so_mounted(arm, assignment):
    robot, log = arm
    some, setup = trials(log, robot), Setup(robot, assignment)
    ways = np.array([[0.0, 0.0, -9.81], [9.0, 2.0, 1.0], [0.0, 0.0, 0.0], [-1.0, 5.0, 3.0]])
    expected = [bound(setup.with_gravity(way), some) for way in ways]
    np.testing.assert_allclose(some.under_gravity(setup)(ways), expected, atol=1e-6)


@pytest.mark.parametrize("assignment", [PLAIN, MIXED])
@pytest.mark.parametrize(("joint", "entry"), [(2, "d"), (2, "r"), (3, "d"), (3, "r")])
def test_the_bound_along_a_length_is_that_of_the_robot_so_described(arm, assignment, joint, entry):
    robot, log = arm
    some, setup = trials(log, robot), Setup(robot, assignment)
    general = robot
    for place, name in ((2, "d"), (2, "r"), (3, "d"), (3, "r")):
        general = with_entry(general, place, name, 0.07 * place)
    errors = np.array([-0.4, -0.05, 0.0, 0.2])
    along = some.along_length(
        setup, general.links, lambda change: with_entry(robot, joint, entry, change).links
    )
    expected = [
        bound(setup.with_links(with_entry(robot, joint, entry, change).links), some) for change in errors
    ]
    np.testing.assert_allclose(along(errors), expected, atol=1e-6)


def test_a_torque_that_is_assigned_is_bounded_as_in_a_log_that_was_so_measured(arm):
    robot, log = arm
    only = replace(PLAIN, torque=PLAIN.torque.exchanged(0, 2).scaled(-2.0, 1))
    read, as_measured = trials(log, robot), trials(assigned(log, only), robot)
    assert bound(Setup(robot, only), read) == pytest.approx(
        bound(Setup(robot, as_measured.samples.as_measured), as_measured), abs=1e-6
    )


def test_set_ups_of_one_motion_are_bounded_side_by_side_as_singly(arm):
    robot, log = arm
    some = trials(log, robot)
    setup = Setup(robot, some.samples.as_measured)
    several = [setup.with_torque(PLAIN.torque.scaled(factor, 1)) for factor in (1.0, -1.0, 30.0)]
    together = stacked([some.equations(own).reduced for own in several]).bound
    np.testing.assert_allclose(together, [bound(own, some) for own in several], atol=1e-9)


def test_columns_of_one_joint_may_be_projected_out_whatever_the_weights():
    """The bound is that of least squares over all columns, weighted in the same rounds."""
    rng = np.random.default_rng(2)
    columns_of = (np.array([0, 1, 2, 3]), np.array([1, 2, 4, 5, 6]))
    rows = [rng.normal(size=(len(columns), 50)) for columns in columns_of]
    torque = [rng.normal(size=(2, 50)) * [[1.0], [30.0]] for _ in columns_of]
    reduced = family([rows], columns_of, torque).at(np.ones(1)).read(Channels.as_measured(2))
    assert reduced.products.shape == (2, 2, 2)
    wide = np.zeros((2, 50, 7))
    for joint, columns in enumerate(columns_of):
        wide[joint][:, columns] = rows[joint].T
    own = np.stack([torque[joint][joint] for joint in range(2)])
    candidates = []
    for start in (np.ones(2), np.sqrt(np.mean(own**2, axis=1))):
        noise = start
        for _ in range(3):
            weighted = (wide / noise[:, None, None]).reshape(-1, 7), (own / noise[:, None]).ravel()
            base, *_ = np.linalg.lstsq(*weighted, rcond=None)
            noise = np.sqrt(np.mean((own - wide @ base) ** 2, axis=1))
        candidates.append(np.mean(np.log(noise / np.sqrt(np.mean(own**2, axis=1)))))
    assert float(reduced.bound) == pytest.approx(min(candidates), abs=1e-6)
