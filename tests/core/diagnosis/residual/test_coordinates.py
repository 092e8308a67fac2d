"""Hold the coordinates of a residual to the motion they come from."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.core.diagnosis.residual.worlds import world
from veritorque.core.diagnosis.residual.coordinates import coordinate, coordinate_names, travel
from veritorque.core.errors import OptionError


def test_every_coordinate_has_a_finite_value_and_a_unit_at_every_row():
    here = world()
    for name in coordinate_names(here.dataset):
        found = coordinate(here.dataset, here.operating_point, name, 3)
        if found is not None:
            assert found.values.shape == here.dataset.time.shape
            assert np.isfinite(found.values).all()
            assert found.unit


def test_what_the_robot_or_the_log_does_not_have_is_none():
    here = world()
    for name in ("temperature", "motor_phase", "velocity_of_joint_3"):
        assert coordinate(here.dataset, here.operating_point, name, 3) is None


def test_the_phase_of_the_motor_turns_as_often_as_the_gear_says():
    here = world()
    joints = (replace(here.dataset.robot.joints[0], gear_ratio=50.0), *here.dataset.robot.joints[1:])
    dataset = replace(here.dataset, robot=replace(here.dataset.robot, joints=joints))
    found = coordinate(dataset, here.operating_point, "motor_phase", 1)
    position = here.dataset.state.position[:, 0]
    np.testing.assert_allclose(np.exp(1j * found.values), np.exp(50j * position), atol=1e-9)
    assert coordinate(dataset, here.operating_point, "motor_phase", 2) is None


def test_temperature_is_given_where_it_was_logged():
    here = world()
    warm = np.tile(np.linspace(20.0, 40.0, len(here.dataset.time))[:, None], (1, 7))
    dataset = replace(here.dataset, state=replace(here.dataset.state, temperature=warm))
    found = coordinate(dataset, here.operating_point, "temperature", 5)
    np.testing.assert_array_equal(found.values, warm[:, 4])
    assert found.unit == "degC"


def test_a_joint_that_slides_has_metres_and_newtons():
    here = world()
    links = tuple(replace(one, kind="prismatic", row=None) for one in here.dataset.robot.links)
    dataset = replace(here.dataset, robot=replace(here.dataset.robot, links=links))
    units = {
        name: coordinate(dataset, here.operating_point, name, 1).unit
        for name in ("time", "position", "acceleration", "load", "torque_rate", "velocity_of_joint_2")
    }
    assert list(units.values()) == ["s", "m", "m/s2", "N", "N/s", "m/s"]


@given(turns=st.integers(1, 5), samples=st.integers(200, 2000))
def test_travel_is_the_way_since_the_last_turn(turns, samples):
    time = np.linspace(0.0, turns, samples)
    position, velocity = -np.cos(np.pi * time), np.pi * np.sin(np.pi * time)
    fraction = time - np.floor(time)
    inside = (fraction > 0.05) & (fraction < 0.95)
    missed = travel(position, velocity) - (1.0 - np.cos(np.pi * fraction))
    # A turn lies between two samples; the way between them is what may be missed.
    assert np.abs(missed[inside]).max() <= np.pi**2 * (turns / samples) ** 2 * 2.0


def test_travel_starts_anew_with_every_stretch():
    here = world()
    first = here.dataset.stretches[0]
    half = (first.rows.start + first.rows.stop) // 2
    parts = (
        replace(first, rows=slice(first.rows.start, half)),
        replace(first, rows=slice(half, first.rows.stop)),
    )
    dataset = replace(here.dataset, stretches=parts)
    assert coordinate(dataset, here.operating_point, "travel", 1).values[half] == 0.0


@pytest.mark.parametrize(
    ("name", "joint"), [("colour", 1), ("time", 0), ("time", 8), ("velocity_of_joint_9", 1)]
)
def test_a_coordinate_that_does_not_exist_is_refused_with_those_that_do(name, joint):
    here = world()
    with pytest.raises(OptionError, match="no such coordinate") as caught:
        coordinate(here.dataset, here.operating_point, name, joint)
    assert "travel" in caught.value.remedy
