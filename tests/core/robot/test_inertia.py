"""What ten numbers say about a body, held against point masses, textbook bodies and moving frames.

Tolerances are rounding: every formula is exact, sums have a few terms of the size of the largest entry.
"""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from veritorque.core.robot.frames import rotation_rpy
from veritorque.core.robot.inertia import (
    from_mass_properties,
    inertia_about_origin,
    link_parameters,
    mass_properties,
    pseudo_inertia,
    transform_body,
)
from veritorque.core.robot.model import INERTIAL_SYMBOLS

SEEDS = st.integers(0, 2**32 - 1)

# Moments about the mass centre of homogeneous bodies of 3 kg, along their principal axes.
# Source: Meriam & Kraige, Engineering Mechanics: Dynamics, Table D/4 (sphere, block, cylinder, slender rod).
TEXTBOOK = {
    "sphere of radius 0.2 m": (np.diag([0.4 * 3 * 0.2**2] * 3), np.diag([0.2**2 / 5] * 3)),
    "block of 0.1 x 0.2 x 0.3 m": (
        3 / 12 * np.diag([0.2**2 + 0.3**2, 0.1**2 + 0.3**2, 0.1**2 + 0.2**2]),
        np.diag([0.1**2, 0.2**2, 0.3**2]) / 12,
    ),
    "cylinder of radius 0.1 m and length 0.4 m along z": (
        np.diag([3 * 0.1**2 / 4 + 3 * 0.4**2 / 12] * 2 + [3 * 0.1**2 / 2]),
        np.diag([0.1**2 / 4, 0.1**2 / 4, 0.4**2 / 12]),
    ),
    "slender rod of 0.6 m along x": (
        3 * 0.6**2 / 12 * np.diag([0.0, 1.0, 1.0]),
        np.diag([0.6**2 / 12, 0.0, 0.0]),
    ),
}


def _points(seed: int, count: int = 12) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    return rng.uniform(0.1, 2.0, count), rng.normal(size=(count, 3))


def _body_of(masses: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Integrate the definitions: XX = int y2 + z2 dm, XY = -int xy dm, MX = int x dm."""
    x, y, z = points.T
    second = {
        "XX": y * y + z * z,
        "XY": -x * y,
        "XZ": -x * z,
        "YY": x * x + z * z,
        "YZ": -y * z,
        "ZZ": x * x + y * y,
    }
    first = {"MX": x, "MY": y, "MZ": z, "M": np.ones_like(x)}
    return np.array([masses @ (second | first)[symbol] for symbol in INERTIAL_SYMBOLS])


@given(SEEDS)
def test_the_pseudo_inertia_of_point_masses_is_the_sum_of_their_outer_products(seed):
    masses, points = _points(seed)
    homogeneous = np.column_stack([points, np.ones(len(points))])
    expected = (homogeneous * masses[:, None]).T @ homogeneous
    np.testing.assert_allclose(pseudo_inertia(_body_of(masses, points)), expected, rtol=1e-12, atol=1e-12)


@given(SEEDS)
def test_a_moved_body_is_the_body_of_its_moved_points(seed):
    masses, points = _points(seed)
    rng = np.random.default_rng(seed)
    rotation, translation = rotation_rpy(*rng.uniform(-np.pi, np.pi, 3)), rng.normal(size=3)
    expected = _body_of(masses, points @ rotation.T + translation)
    np.testing.assert_allclose(
        transform_body(_body_of(masses, points), rotation, translation), expected, rtol=1e-11, atol=1e-11
    )


@given(SEEDS)
def test_a_moved_body_keeps_its_mass_and_turns_its_inertia_about_its_centre(seed):
    body = _body_of(*_points(seed))
    rng = np.random.default_rng(seed)
    rotation, translation = rotation_rpy(*rng.uniform(-np.pi, np.pi, 3)), rng.normal(size=3)
    mass, centre, inertia = mass_properties(body)
    after = mass_properties(transform_body(body, rotation, translation))
    assert after[0] == pytest.approx(mass, rel=1e-14)
    np.testing.assert_allclose(after[1], rotation @ centre + translation, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(after[2], rotation @ inertia @ rotation.T, rtol=1e-10, atol=1e-11)


@given(SEEDS)
def test_ten_parameters_survive_both_ways_of_writing_them(seed):
    body = _body_of(*_points(seed))
    np.testing.assert_allclose(link_parameters(pseudo_inertia(body)), body, rtol=1e-14, atol=1e-13)
    np.testing.assert_allclose(from_mass_properties(*mass_properties(body)), body, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize(("inertia", "spread"), TEXTBOOK.values(), ids=TEXTBOOK)
def test_the_pseudo_inertia_of_a_textbook_body_holds_its_mean_square_extent(inertia, spread):
    body = from_mass_properties(3.0, np.zeros(3), inertia)
    np.testing.assert_allclose(pseudo_inertia(body)[:3, :3], 3.0 * spread, atol=1e-16)
    assert np.linalg.eigvalsh(pseudo_inertia(body))[0] > -1e-16


def test_a_rod_about_its_end_has_four_times_the_moment_about_its_centre():
    rod = from_mass_properties(3.0, np.array([0.3, 0.0, 0.0]), TEXTBOOK["slender rod of 0.6 m along x"][0])
    np.testing.assert_allclose(
        inertia_about_origin(rod), 3.0 * 0.6**2 / 3.0 * np.diag([0.0, 1.0, 1.0]), atol=1e-16
    )


def test_a_body_that_breaks_the_triangle_inequality_is_inconsistent_with_a_positive_spatial_inertia():
    inertia = np.diag([1.0, 1.0, 3.0])
    body = from_mass_properties(1.0, np.zeros(3), inertia)
    spatial = np.block([[inertia, np.zeros((3, 3))], [np.zeros((3, 3)), np.eye(3)]])
    assert np.linalg.eigvalsh(spatial)[0] > 0.0
    assert np.linalg.eigvalsh(pseudo_inertia(body))[0] == pytest.approx(-0.5)


def test_a_body_without_mass_has_its_centre_at_the_origin():
    mass, centre, inertia = mass_properties(np.zeros(10))
    assert mass == 0.0
    assert not centre.any()
    assert not inertia.any()
