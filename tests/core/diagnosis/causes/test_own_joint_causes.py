"""Causes have grids without gaps, meaningful sites and physically admissible sizes."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.core.dynamics.terms.motions import swinging
from tests.tools import Motion, pinocchio_torque, random_bodies, random_robot
from veritorque.core.diagnosis.causes.cable_force import CableForce
from veritorque.core.diagnosis.causes.friction_asymmetric import FrictionAsymmetric
from veritorque.core.diagnosis.causes.friction_position_dependent import FrictionPositionDependent
from veritorque.core.diagnosis.causes.friction_presliding import FrictionPresliding
from veritorque.core.diagnosis.causes.friction_temperature import FrictionTemperature
from veritorque.core.diagnosis.causes.friction_viscous_nonlinear import FrictionViscousNonlinear
from veritorque.core.diagnosis.causes.imitation import imitations
from veritorque.core.diagnosis.causes.joint_coupling import JointCoupling
from veritorque.core.diagnosis.causes.protocol import Cause, FittedCause, Setting
from veritorque.core.diagnosis.causes.rotor_inertia_missing import RotorInertiaMissing
from veritorque.core.diagnosis.causes.shared.harmonics import harmonics, wave_quantities
from veritorque.core.diagnosis.causes.spring_compensator import SpringCompensator
from veritorque.core.diagnosis.causes.torque_gain_nonlinear import TorqueGainNonlinear
from veritorque.core.diagnosis.causes.torque_offset_drift import TorqueOffsetDrift
from veritorque.core.diagnosis.causes.torque_ripple import TorqueRipple
from veritorque.core.diagnosis.causes.torque_saturation import TorqueSaturation
from veritorque.core.diagnosis.dataset.dataset import Dataset, build_dataset
from veritorque.core.dynamics.model import standard_model
from veritorque.core.dynamics.prediction import Prediction
from veritorque.core.dynamics.terms.coulomb import Coulomb
from veritorque.core.dynamics.terms.offset import Offset
from veritorque.core.dynamics.terms.viscous import Viscous
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.model import Coupling

CAUSES: tuple[Cause, ...] = (
    CableForce(),
    FrictionAsymmetric(),
    FrictionPositionDependent(),
    FrictionPresliding(),
    FrictionTemperature(),
    FrictionViscousNonlinear(),
    JointCoupling(),
    RotorInertiaMissing(),
    SpringCompensator(),
    TorqueGainNonlinear(),
    TorqueOffsetDrift(),
    TorqueRipple(),
    TorqueSaturation(),
)
SCANNED = tuple(
    cause
    for cause in CAUSES
    if isinstance(
        cause,
        FrictionPositionDependent
        | FrictionPresliding
        | FrictionTemperature
        | FrictionViscousNonlinear
        | TorqueOffsetDrift
        | TorqueRipple
        | CableForce,
    )
)
ALIKE = 0.75
"""The golden section between grid points climbs from either side where neighbours are as alike as this."""


@pytest.fixture(scope="module")
def scene() -> tuple[Dataset, Prediction]:
    """Prepare 20 s of a three-joint robot's motion; the torque is pinocchio's."""
    robot, bodies = (
        random_robot(np.random.default_rng(1), 3, prismatic=0.0),
        random_bodies(np.random.default_rng(2), 3),
    )
    robot = replace(robot, joints=(replace(robot.joints[0], rotor_inertia=False), *robot.joints[1:]))
    state = swinging(3, 20.0)
    torque = pinocchio_torque(robot, bodies, Motion(state.position, state.velocity, state.acceleration))
    log = log_from_arrays("scene", np.asarray(state.time), state.position, torque)
    dataset = build_dataset(standard_model(robot), (log,), held_out=frozenset(), blocks=5)
    return dataset, Prediction(standard_model(robot, ("rigid_body",)), bodies.ravel())


def solved(cause: Cause, dataset: Dataset, operating_point: Prediction, values: list[float]) -> FittedCause:
    """Make a solution at the cause's first site and grid point."""
    site = cause.sites(dataset)[0]
    scalars = cause.grid(Setting(dataset, operating_point, site))[0]
    count = len(cause.term(Setting(dataset, operating_point, site, scalars)).parameters(dataset.robot))
    assert count == len(values)
    return FittedCause(site, np.array(values), 0.01 * np.eye(count), scalars, dict.fromkeys(scalars, 0.1))


def as_found(cause: Cause, dataset: Dataset, operating_point: Prediction, value: float) -> FittedCause:
    """Give all linear parameters the same value."""
    site = cause.sites(dataset)[0]
    term = cause.term(
        Setting(dataset, operating_point, site, cause.grid(Setting(dataset, operating_point, site))[0])
    )
    return solved(cause, dataset, operating_point, [value] * len(term.parameters(dataset.robot)))


@pytest.mark.parametrize("cause", CAUSES, ids=lambda cause: cause.id)
def test_a_cause_says_in_one_sentence_which_joint_and_how_much(
    cause: Cause, scene: tuple[Dataset, Prediction]
) -> None:
    found = as_found(cause, *scene, 2.0)
    text = cause.statement(found)
    assert f"oint {found.site[-1]}" in text or f"joints {found.site[0]} and {found.site[-1]}" in text
    assert "±" in text
    assert "nan" not in text
    assert len(text) < 220


@pytest.mark.parametrize("cause", CAUSES, ids=lambda cause: cause.id)
def test_a_cause_names_what_it_imitates_with_an_experiment_each(cause: Cause) -> None:
    assert cause.experiment
    assert imitations(cause.id)
    for other, entry in imitations(cause.id).items():
        assert other != cause.id
        assert len(entry.experiment) > 20


@pytest.mark.parametrize("cause", CAUSES, ids=lambda cause: cause.id)
def test_the_numbers_of_a_finding_come_with_unit_and_deviation(
    cause: Cause, scene: tuple[Dataset, Prediction]
) -> None:
    quantities = cause.quantities(as_found(cause, *scene, 2.0))
    assert len({one.name for one in quantities}) == len(quantities)
    assert all(one.unit and np.isfinite(one.value) for one in quantities)
    assert all(one.standard_deviation > 0.0 for one in quantities)


@pytest.mark.parametrize(
    "cause",
    [CableForce(), FrictionPresliding(), RotorInertiaMissing(), TorqueSaturation(), JointCoupling()],
    ids=lambda cause: cause.id,
)
def test_friction_springs_and_inertia_of_the_wrong_sign_are_not_admissible(
    cause: Cause, scene: tuple[Dataset, Prediction]
) -> None:
    assert cause.admissible(as_found(cause, *scene, 2.0))
    assert not cause.admissible(as_found(cause, *scene, -2.0))


def test_a_coupling_may_lack_inertia_within_its_uncertainty_but_not_everything(
    scene: tuple[Dataset, Prediction],
) -> None:
    assert JointCoupling().admissible(solved(JointCoupling(), *scene, [-0.1, 2.0, 2.0]))
    assert not JointCoupling().admissible(solved(JointCoupling(), *scene, [-0.1, 0.1, 0.1]))


def test_a_friction_level_is_the_same_after_a_turn(scene: tuple[Dataset, Prediction]) -> None:
    found = solved(FrictionPositionDependent(), *scene, [1.0, 1.0])
    waves = [replace(found, scalars={**found.scalars, "harmonic": each}) for each in (0.3, 0.8, 2.0)]
    assert [FrictionPositionDependent().admissible(wave) for wave in waves] == [False, True, True]


@pytest.mark.parametrize("cause", SCANNED, ids=lambda cause: cause.id)
def test_neighbours_of_a_grid_are_so_correlated_that_nothing_between_them_is_missed(
    cause: Cause, scene: tuple[Dataset, Prediction]
) -> None:
    dataset, operating_point = scene
    grid = cause.grid(Setting(dataset, operating_point, (2,)))
    found = dataset.columns(
        [cause.term(Setting(dataset, operating_point, (2,), scalars)) for scalars in grid]
    )
    model = np.hstack([columns[1] for columns in dataset.columns([Offset(), Viscous(), Coulomb()])])
    for one, other, here, there in zip(found, found[1:], grid, grid[1:], strict=False):
        if here.get("side") == there.get("side"):
            spans = [np.linalg.qr(_left(columns[1], model))[0] for columns in (one, other)]
            assert np.linalg.svd(spans[0].T @ spans[1])[1].min() > ALIKE, (here, there)


def _left(columns: np.ndarray, model: np.ndarray) -> np.ndarray:
    return np.asarray(columns - model @ np.linalg.lstsq(model, columns, rcond=None)[0])


def test_ripple_is_scanned_up_to_the_bandwidth(scene: tuple[Dataset, Prediction]) -> None:
    dataset, operating_point = scene
    highest = max(
        scalars["harmonic"] for scalars in TorqueRipple().grid(Setting(dataset, operating_point, (1,)))
    )
    assert highest * dataset.speed[0] < 2.0 * np.pi * dataset.band_hz < 3.0 * highest * dataset.speed[0]


def test_only_joints_without_a_declared_rotor_may_miss_one(scene: tuple[Dataset, Prediction]) -> None:
    assert RotorInertiaMissing().sites(scene[0]) == [(1,)]


def test_a_declared_coupling_is_no_candidate(scene: tuple[Dataset, Prediction]) -> None:
    dataset, _ = scene
    assert set(JointCoupling().sites(dataset)) == {(1, 2), (2, 3), (1, 3)}
    declared = replace(dataset.robot, couplings=(Coupling("wrist", 3, (2, 3), (1.0, 1.0)),))
    assert set(JointCoupling().sites(replace(dataset, robot=declared))) == {(1, 2), (1, 3)}


def test_friction_follows_the_logged_temperature_where_there_is_one(
    scene: tuple[Dataset, Prediction],
) -> None:
    dataset, operating_point = scene
    cause = FrictionTemperature()
    assert all("time_constant" in scalars for scalars in cause.grid(Setting(dataset, operating_point, (1,))))
    warm = replace(
        dataset, state=replace(dataset.state, temperature=np.full_like(dataset.state.position, 30.0))
    )
    assert list(cause.grid(Setting(warm, operating_point, (1,)))) == [{}]
    found = FittedCause((1,), np.array([0.1, 0.2]), np.eye(2), {}, {})
    assert [one.unit for one in cause.quantities(found)] == ["N m/K", "N m s/rad/K"]


@given(
    amplitude=st.floats(0.01, 100.0),
    harmonic=st.floats(1.0, 50.0),
    phase=st.floats(-3.1, 3.1),
    centre=st.floats(-3.0, 3.0),
)
def test_a_wave_about_the_middle_of_the_range_is_reported_with_its_phase_at_zero(
    amplitude: float, harmonic: float, phase: float, centre: float
) -> None:
    at_centre = harmonic * centre + phase
    parts = amplitude * np.array([np.cos(at_centre), -np.sin(at_centre)])
    scalars = {"harmonic": harmonic, "centre": centre}
    found = {
        one.name: one.value
        for one in wave_quantities(FittedCause((1,), parts, np.eye(2), scalars, {}), "N m")
    }
    angle = np.linspace(-3.0, 3.0, 20)
    wave = found["amplitude"] * np.cos(found["harmonic"] * angle + found["phase"])
    np.testing.assert_allclose(wave, amplitude * np.cos(harmonic * angle + phase), atol=1e-9 * amplitude)


def test_the_deviation_of_a_phase_holds_that_of_the_harmonic() -> None:
    rng = np.random.default_rng(0)
    scatter, parts, covariance = 0.02, np.array([3.0, -4.0]), np.diag([0.01, 0.02])
    draws = rng.multivariate_normal(parts, covariance, 4000)
    turns = 6.0 + scatter * rng.normal(size=4000)
    phases = [
        wave_quantities(FittedCause((1,), one, covariance, {"harmonic": float(h), "centre": 1.5}, {}), "N m")[
            2
        ].value
        for one, h in zip(draws, turns, strict=True)
    ]
    stated = wave_quantities(
        FittedCause((1,), parts, covariance, {"harmonic": 6.0, "centre": 1.5}, {"harmonic": scatter}), "N m"
    )[2].standard_deviation
    # 4000 draws know a deviation to 1.1 %.
    assert stated == pytest.approx(np.std(phases), rel=0.05)


def test_a_short_range_separates_only_distant_harmonics_and_a_long_one_integer_ones() -> None:
    short, long = (
        [one["harmonic"] for one in harmonics(np.array([0.0, reach]), lowest=2.0, highest=20.0, most=99)]
        for reach in (0.4, 5.0)
    )
    assert np.diff(short).min() == pytest.approx(4.0)
    assert long == [float(number) for number in range(2, 21)]


@pytest.mark.parametrize(
    "cause", [one for one in CAUSES if one.id != "joint_coupling"], ids=lambda cause: cause.id
)
def test_a_statement_about_a_prismatic_joint_is_in_metres_and_newtons(cause, scene):
    found = replace(as_found(cause, *scene, 0.1), slides=True)
    units = {one.name: one.unit for one in cause.quantities(found) if one.name != "phase"}
    told = [*units.values(), cause.statement(found)]
    assert not [one for one in told if "N m" in one or "rad" in one]
