"""A robot under its own controller moves as it was logged, whatever noise the log holds."""

import json
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from tests.core.simulation.closed_loop.test_loop import world
from tests.core.simulation.control.test_controller import CASCADE, PD, driven
from tests.tools import shared
from veritorque.core.errors import OptionError
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import log_from_arrays, read_log
from veritorque.core.robot.description import robot_from_description
from veritorque.core.signals.condition import condition
from veritorque.core.simulation.closed_loop.controlled import Controlled
from veritorque.core.simulation.closed_loop.simulated import SimulatedMotion
from veritorque.core.simulation.control.declared import DeclaredController
from veritorque.core.simulation.control.own_controller import controller_of
from veritorque.core.study import IdentifyRequest, identify

SETTLED = 1500
"""Samples after which nothing is left of a start that the filters have blurred."""


def moved(machine, log, controller):
    """Simulate a log under a controller, and give the samples of all tiles, each once."""
    motion = condition(log, machine.robot)
    played = SimulatedMotion(motion, machine, Controlled(controller))
    parts, begin = [], -np.inf
    for tile in played.tiles():
        fresh = tile.state.time > begin + 1e-9
        parts.append(tile.state.position[fresh])
        begin = tile.state.time[-1]
    return np.vstack(parts)


@pytest.mark.parametrize(
    "controller",
    [CASCADE, replace(CASCADE, velocity="two_tap", delay_samples=2), replace(PD, delay_samples=-1)],
)
def test_the_true_robot_moves_as_it_was_logged(controller):
    machine = world("slide")
    played, log = driven(machine, controller)
    found = moved(machine, log, controller)
    size = np.std(played.state.position)
    late = (found - played.state.position)[SETTLED:]
    assert np.sqrt(np.mean(late**2)) < 1e-6 * size


def test_what_was_measured_drives_nothing():
    machine = world("slide")
    played, log = driven(machine, CASCADE)
    rows, rng = whole_rows(log), np.random.default_rng(3)
    noise = 1e-4 * rng.normal(size=(2, *rows.position.shape))
    references = {"position_ref": rows.position_ref, "command": rows.command}
    noisy = log_from_arrays(
        "noisy", rows.time, rows.position + noise[0], rows.torque + noise[1], **references
    )
    found = moved(machine, noisy, CASCADE)
    assert np.abs((found - played.state.position)[SETTLED:]).max() < 1e-6 * np.std(played.state.position)


def test_the_references_of_a_log_with_uneven_stamps_are_taken_at_its_clock():
    machine = world("slide")
    played, log = driven(machine, CASCADE)
    rows = whole_rows(log)
    kept = np.delete(np.arange(len(rows.time)), np.arange(700, 5000, 97))
    series = {name: getattr(rows, name)[kept] for name in ("position", "torque", "position_ref", "command")}
    uneven = log_from_arrays("uneven", rows.time[kept], **series)
    found = moved(machine, uneven, CASCADE)
    steps = np.linspace(rows.time[0], rows.time[-1], len(found))
    expected = np.interp(steps, rows.time, played.state.position[:, 0])
    assert np.abs(found[SETTLED:, 0] - expected[SETTLED:]).max() < 2e-3 * np.std(expected)


def test_a_command_that_no_known_controller_gives_is_refused():
    _, log = driven(world("slide"), CASCADE)
    rows = whole_rows(log)
    drawn = np.random.default_rng(4).normal(size=rows.command.shape)
    other = log_from_arrays(
        "other", rows.time, rows.position, rows.torque, position_ref=rows.position_ref, command=drawn
    )
    with pytest.raises(OptionError, match="the torque falls where the command rises"):
        controller_of(other)
    unrelated = log_from_arrays(
        "unrelated", rows.time, rows.position, drawn, position_ref=rows.position_ref, command=drawn
    )
    with pytest.raises(OptionError, match="no known controller"):
        controller_of(unrelated)


def test_a_declared_controller_that_does_not_recompute_the_command_is_refused_with_the_one_that_does():
    _, log = driven(world("slide"), CASCADE)
    with pytest.raises(OptionError, match="the declared controller does not recompute") as refused:
        controller_of(log, DeclaredController(kind="cascade", velocity="backward", delay_samples=1))
    assert refused.value.evidence["recognised"]["delay_samples"] == 0
    assert controller_of(log, DeclaredController(kind="cascade", kp=CASCADE.kp)).accepted


@pytest.mark.parametrize(("name", "value"), [("saturation", 1.0), ("torque_gain", 20.0)])
def test_a_declared_limit_or_gain_that_the_log_contradicts_is_refused_with_what_it_shows(servo, name, value):
    _, log = servo
    with pytest.raises(OptionError, match=f"{name} of the controller contradicts") as refused:
        controller_of(log, DeclaredController(**{name: (value,)}))
    (shown,) = refused.value.evidence["in_the_log"]
    # Source: Janot, Gautier & Brunot 2019 for the gain, 35.15 N/V.
    assert shown == pytest.approx({"saturation": 4.32, "torque_gain": 35.15}[name], rel=0.2)


def test_a_declared_controller_drives_the_simulation_and_stands_in_the_result(servo):
    robot, log = servo
    # Gains as published for the benchmark (Janot, Gautier & Brunot 2019).
    declared = {
        "kind": "cascade",
        "kp": [160.18],
        "kd": [243.45],
        "velocity": "two_tap",
        "torque_gain": [35.15065],
    }
    options = {
        "estimator": "didim",
        "simulation": {"from": "controller"},
        "controller": declared,
        "bootstrap": {"draws": 0},
    }
    (told,) = identify(IdentifyRequest(robot, (log,), options))["estimation"]["simulation"]["controllers"]
    assert {name: told[name] for name in declared} == declared
    assert told["declared"] == ["kind", "kp", "kd", "torque_gain", "velocity"]
    assert told["delay_samples"] == 0
    assert max(told["command_residual_percent"]) < 2.0


def test_a_log_of_currents_or_without_references_is_refused():
    _, log = driven(world("slide"), CASCADE)
    rows = whole_rows(log)
    currents = log_from_arrays(
        "currents",
        rows.time,
        rows.position,
        None,
        current=rows.torque,
        position_ref=rows.position_ref,
        command=rows.command,
    )
    with pytest.raises(OptionError, match="holds currents"):
        controller_of(currents)
    with pytest.raises(OptionError, match="does not show what its controller did"):
        controller_of(log_from_arrays("bare", rows.time, rows.position, rows.torque))


def test_a_controller_is_looked_for_in_the_log_whose_conflicts_are_corrected():
    machine = world("slide")
    _, log = driven(machine, CASCADE)
    rows = whole_rows(log)
    reversed_log = log_from_arrays(
        "reversed",
        rows.time,
        rows.position,
        -rows.torque,
        position_ref=rows.position_ref,
        command=-rows.command,
    )
    options = {"estimator": "iv", "simulation": {"from": "controller"}, "bootstrap": {"draws": 0}}
    right, corrected = (
        identify(IdentifyRequest(machine.robot, (one,), options)) for one in (log, reversed_log)
    )
    assert [row["conflict"] for row in corrected["conflicts"]] == ["torque_sign"]
    np.testing.assert_allclose(
        [row["value"] for row in corrected["base_parameters"]],
        [row["value"] for row in right["base_parameters"]],
        rtol=1e-9,
    )


@pytest.fixture(scope="module")
def servo():
    """Give the field's servo axis and its log."""
    folder = shared("data/emps/runs/track.parquet").parents[1]
    return robot_from_description(json.loads((folder / "robot.json").read_text())), read_log(
        folder / "runs/track.parquet"
    )


PUBLISHED = {"M1": (94.8, 95.5), "FV1": (200.0, 211.0), "FC1": (19.8, 20.6), "OFF1": (-3.6, -3.0)}
"""Source: Janot, Gautier & Brunot 2019, least squares and closed-loop estimators, on rows of equal weight."""


# By replay errors of the model act on the output: clie's and cloe's values are off by up to 1 % and 5 %.
@pytest.mark.parametrize(
    ("estimator", "source"),
    [
        *product(("iv", "didim"), ("replay", "controller")),
        ("iv", "periods"),
        ("clie", "controller"),
        ("cloe", "controller"),
    ],
)
def test_a_measured_servo_axis_has_its_published_parameters(servo, estimator, source):
    robot, log = servo
    options = {
        "estimator": estimator,
        "simulation": {"from": source},
        "weigh_reversals": False,
        "validation": {"fraction": 0.0},
        "bootstrap": {"draws": 0},
    }
    found = identify(IdentifyRequest(robot, (log,), options))
    values = {row["name"]: row["value"] for row in found["base_parameters"]}
    assert all(low <= values[name] <= high for name, (low, high) in PUBLISHED.items()), values
    assert found["estimation"]["converged"]
    simulation = found["estimation"]["simulation"]
    controllers = simulation["controllers"]
    assert len(controllers) == (source == "controller")
    # Source: 1.6 um of the axis under its own controller, by two independent analyses of this log.
    assert max(simulation["position_rms"]) < (1.7e-6 if controllers else 2e-5)
    for one in controllers:
        assert (one["kind"], one["velocity"]) == ("cascade", "two_tap")
        assert max(one["command_residual_percent"]) < 0.3


def test_a_reference_that_is_a_sample_late_in_the_log_changes_nothing_but_the_delay(servo):
    robot, log = servo
    rows = whole_rows(log)
    late = np.vstack([rows.position_ref[:1], rows.position_ref[:-1]])
    shifted = log_from_arrays(
        "late", rows.time, rows.position, rows.torque, position_ref=late, command=rows.command
    )
    delays = [controller_of(one).model.delay_samples for one in (log, shifted)]
    assert delays[1] == delays[0] - 1
    options = {"estimator": "iv", "simulation": {"from": "controller"}, "bootstrap": {"draws": 0}}
    first, second = (
        [row["value"] for row in identify(IdentifyRequest(robot, (one,), options))["base_parameters"]]
        for one in (log, shifted)
    )
    np.testing.assert_allclose(second, first, rtol=3e-3)
