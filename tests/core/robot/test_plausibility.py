"""What looks wrong about a usable description is said, and what is merely unusual is not."""

import json

import numpy as np
import pytest

from tests.tools import shared
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.plausibility import plausibility_warnings
from veritorque.core.robot.urdf.read import robot_from_urdf

# KUKA-like proportions in Khalil's convention.
QUARTER = np.pi / 2
ROWS = [(0.0, 0.0, 0.34, 0.0), (-QUARTER, 0.0, 0.0, 0.0), (QUARTER, 0.05, 0.4, np.pi)]


def _warnings(rows: list[tuple[float, ...]] = ROWS, **others: object) -> tuple[str, ...]:
    joints = [
        {"type": "revolute", **dict(zip(("alpha", "d", "r", "theta_offset"), row, strict=True))}
        for row in rows
    ]
    return plausibility_warnings(robot_from_description({"name": "arm", "joints": joints} | others))


def test_a_plain_table_raises_no_warning():
    assert _warnings() == ()


@pytest.mark.parametrize("name", ["franka_panda", "rokae_xmate3", "staubli_tx40"])
def test_the_tables_of_real_robots_raise_no_warning(name):
    table = json.loads(shared(f"data/{name}/model_mdh.json").read_text())
    rows = [(row["alpha"], row["d"], row["r"], row["theta"]) for row in table["mdh"]]
    assert _warnings(rows, gravity=table["gravity"]) == ()


def test_a_table_written_in_degrees_and_millimetres_is_reported():
    rows = [(90.0 if row[0] else 0.0, 1000 * row[1], 1000 * row[2], 180.0 if row[3] else 0.0) for row in ROWS]
    said = _warnings(rows)
    assert sum("were degrees meant" in line for line in said) == 3
    assert sum("millimetres or centimetres meant" in line for line in said) == 2


def test_letters_of_craig_are_reported():
    rows = [(alpha, r, d, theta) for alpha, d, r, theta in ROWS]
    assert any("Khalil's d is Craig's a" in line for line in _warnings(rows))


def test_a_standard_table_is_reported():
    # The same arm with alpha of the next joint in every row, as in distal Denavit-Hartenberg.
    rows = [(-1.5708, 0.0, 0.34, 0.0), (1.5708, 0.05, 0.0, 0.0), (0.0, 0.0, 0.4, 3.1416)]
    assert any("standard Denavit-Hartenberg" in line for line in _warnings(rows))


@pytest.mark.parametrize(
    ("gravity", "words"),
    [
        ((0.0, 0.0, 9.81), "gravity points along"),
        ((0.0, 0.0, -981.0), "on Earth"),
        ((0.0, 0.0, 0.0), "on Earth"),
    ],
)
def test_gravity_that_points_up_or_is_not_that_of_the_earth_is_reported(gravity, words):
    said = _warnings(gravity=list(gravity))
    assert len(said) == 1
    assert words in said[0]


def test_a_tilted_base_is_not_reported():
    assert _warnings(gravity=[-5.307, -6.843, -4.609]) == ()


def test_position_limits_in_degrees_are_reported():
    row = {
        "type": "revolute",
        "alpha": 0,
        "d": 0,
        "r": 0.3,
        "theta_offset": 0,
        "limits": {"position": [-170, 170]},
    }
    said = plausibility_warnings(robot_from_description({"name": "arm", "joints": [row]}))
    assert len(said) == 1
    assert "were degrees or mm meant" in said[0]


@pytest.mark.parametrize("name", ["ur10e_open", "staubli_tx40"])
def test_the_urdfs_of_real_robots_raise_no_warning(name):
    assert plausibility_warnings(robot_from_urdf(shared(f"data/{name}/robot.urdf").read_bytes())) == ()


def _said_of(alpha: float) -> str:
    row = {"type": "revolute", "d": 0.0, "r": 0.2, "theta_offset": 0.0}
    arm = {"name": "arm", "joints": [row | {"alpha": 0.0}, row | {"alpha": alpha}]}
    return " ".join(plausibility_warnings(robot_from_description(arm)))


@pytest.mark.parametrize("alpha", [1.57, 1.571, -3.14, QUARTER + 3e-4, QUARTER - 1.23456e-6])
def test_an_angle_that_misses_a_right_angle_by_a_little_is_reported_and_kept(alpha):
    assert "were right angles meant" in _said_of(alpha)


@pytest.mark.parametrize("alpha", [1.5708, -1.57079, 3.1416, 4.7124, 1.5707])
def test_an_angle_that_is_taken_for_a_right_angle_is_said(alpha):
    assert "taken for the right angles" in _said_of(alpha)
    assert "were right angles meant" not in _said_of(alpha)


@pytest.mark.parametrize("alpha", [0.98, QUARTER, 0.0, 1.5707963, -np.pi])
def test_other_angles_and_right_ones_are_not_mentioned(alpha):
    assert not _said_of(alpha)
