"""The number of base parameters is the rank of an independent engine's regressor; `make ranks` draws 250."""

import numpy as np
import pytest

from tests.ranks.compare import compare
from tests.ranks.drawn import STYLES
from tests.ranks.engine import rank_of
from veritorque.core.dynamics.model import standard_model
from veritorque.core.reduction.base import base_model
from veritorque.core.robot.frames import rpy_of_rotation
from veritorque.core.robot.modified_dh import ModifiedDHRow
from veritorque.core.robot.urdf.read import robot_from_urdf


@pytest.mark.parametrize("seed", range(2 * len(STYLES)))
def test_the_base_parameters_of_a_drawn_urdf_are_as_many_as_the_rank_of_pinocchios_regressor(seed):
    found = compare(seed)
    assert found.engine.is_clear
    assert found.ours == found.engine.count


def test_a_calibration_that_puts_common_normals_hundreds_of_metres_away_has_the_rank_of_its_arm():
    # Nearly parallel axes meet far away: factory calibrations are written with lengths that cancel.
    quarter = np.pi / 2
    rows = [
        ModifiedDHRow(alpha=0.0, d=0.0, r=0.09, theta=-1e-5),
        ModifiedDHRow(alpha=quarter - 4.1e-4, d=2.6e-4, r=431.2, theta=-1.44),
        ModifiedDHRow(alpha=-6.2e-4, d=-0.061, r=-380.5, theta=2.03),
        ModifiedDHRow(alpha=2.9e-3, d=-0.31, r=-50.6, theta=-0.59),
        ModifiedDHRow(alpha=quarter - 3.9e-4, d=1.3e-5, r=0.094, theta=4.4e-5),
        ModifiedDHRow(alpha=-quarter - 2.1e-4, d=2.1e-7, r=0.083, theta=7.9e-6),
    ]
    text = _urdf(rows)
    rank = rank_of(text, 0)
    assert rank.is_clear
    assert len(base_model(standard_model(robot_from_urdf(text))).kept) == rank.count


@pytest.mark.parametrize("seed", [7700023, 7700028])
def test_a_parameter_that_hardly_shows_is_told_from_the_rounding_of_others_that_hardly_show(seed):
    """One of the first's columns is independent by 6e-10; rounding leaves as much of one of the second's."""
    found = compare(seed)
    assert found.ours == found.engine.count


def _urdf(rows: list[ModifiedDHRow]) -> str:
    inertial = (
        '<inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    )
    parts = ['<link name="0"/>']
    for number, row in enumerate(rows, start=1):
        rotation, translation = row.placement()
        xyz, rpy = (" ".join(map(repr, part.tolist())) for part in (translation, rpy_of_rotation(rotation)))
        parts.append(
            f'<link name="{number}">{inertial}</link><joint name="j{number}" type="continuous">'
            f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="0 0 1"/><parent link="{number - 1}"/>'
            f'<child link="{number}"/></joint>'
        )
    return f'<robot name="calibrated">{"".join(parts)}</robot>'
