"""Causes are searched in torques from which dead zones were taken out, at the width that the model tells."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.diagnosis.causes.test_sample_checks import (
    DEAD,
    ZONES,
    looked_at,
    operating_point,
    recorded,
    with_torque,
)
from veritorque.core.diagnosis.causes.torque_dead_zone import dead_zones
from veritorque.core.diagnosis.checks import zone_width
from veritorque.core.diagnosis.checks.cut_torque import cut_channels
from veritorque.core.diagnosis.checks.samples import check_samples
from veritorque.core.diagnosis.checks.zone_width import refined_zones
from veritorque.core.diagnosis.problem import DiagnosisProblem
from veritorque.core.identification.reference import Reference
from veritorque.core.log.model import JointLog
from veritorque.core.reduction.base import base_model
from veritorque.core.regressor.columns import all_columns
from veritorque.core.signals.dead_zone import DeadZone

SHRINKS = "too little by as much"


def problem(*logs: JointLog) -> DiagnosisProblem:
    return DiagnosisProblem(all_columns(operating_point().model), logs, frozenset(), 5)


@pytest.mark.parametrize("words", ZONES)
def test_the_torque_in_which_causes_are_searched_is_the_one_that_acted(words):
    spoilt = with_torque(ZONES[words][0])
    asked, faults, fitter = check_samples(problem(spoilt))
    assert [(zone.joint, zone.shortfall > 0.0) for zone in asked.zones] == [(0, words == SHRINKS)]
    assert [one.cause for one in faults] == ["torque_dead_zone"]
    found, plain = fitter.dataset, check_samples(problem(recorded()))[2].dataset
    both = found.usable & plain.usable
    difference = np.where(both, found.torque - plain.torque, 0.0)
    assert both[:, 0].sum() > 0.5 * plain.usable[:, 0].sum()
    np.testing.assert_array_equal(difference[:, 1], 0.0)
    assert np.abs(difference).max() < 0.02 * DEAD


def test_the_model_tells_the_width_better_than_the_zeros_do():
    spoilt = with_torque(ZONES[SHRINKS][0])
    (counted,) = dead_zones(looked_at(spoilt))
    asked, (fault,), _ = check_samples(problem(spoilt))
    (width,) = fault.quantities
    assert width.value == pytest.approx(asked.zones[0].half)
    assert width.standard_deviation < 0.3 * counted.deviation
    assert abs(width.value - DEAD) < 3.0 * width.standard_deviation


def test_a_zone_is_found_where_friction_makes_torques_jump_out_of_it():
    """Beside one end of a stretch of zeros the torque is then as large as anywhere."""
    friction, half = 20.0, 4.0
    rows = recorded().source.data
    way = np.sign(np.gradient(rows.position[:, 0], rows.time))

    def rubbed(torque: np.ndarray) -> np.ndarray:
        acts = torque + friction * way
        return np.sign(acts) * np.maximum(np.abs(acts) - half, 0.0)

    (zone,) = dead_zones(looked_at(with_torque(rubbed)))
    assert zone.half == pytest.approx(half, abs=3.0 * zone.deviation)


def test_a_zone_is_as_wide_beside_another_effect_of_the_torque():
    """A channel that loses a tenth of the largest torque, by its cube."""
    asked, _, _ = check_samples(
        problem(with_torque(lambda torque: ZONES[SHRINKS][0](torque * (1.0 - 0.1 * (torque / 42.0) ** 2))))
    )
    assert [zone.half for zone in asked.zones] == pytest.approx([DEAD], rel=0.03)


@pytest.mark.parametrize(("more", "deviation", "zones"), [(-0.1, 0.05, 0), (-0.08, 0.4, 0), (0.0, 0.02, 1)])
def test_a_zone_no_wider_than_its_deviation_is_none(monkeypatch, more, deviation, zones):
    """Zeros of a channel that is none of a torque tell a width that the model does not know either."""
    monkeypatch.setattr(zone_width, "_causes_on", lambda *_: [])
    monkeypatch.setattr(zone_width, "_lacking", lambda *_: [(more, deviation)])
    found = check_samples(problem(recorded()))[2]
    counted = DeadZone(0, 0, 0.1, 0.3, 0.1, 50, 0.1, 1e-9)
    refined = refined_zones([counted], found.dataset, (found, found.fit(())))
    assert len(refined) == zones
    assert all(zone.half > zone.deviation for zone in refined)


def test_of_two_logs_the_one_with_a_zone_is_restored():
    spoilt, sound = with_torque(ZONES[SHRINKS][0]), recorded(seed=8)
    asked, (fault,), fitter = check_samples(problem(sound, spoilt))
    (zone,) = asked.zones
    assert (zone.log, zone.joint) == (1, 0)
    assert zone.half == pytest.approx(DEAD, abs=3.0 * zone.deviation)
    assert fault.quantities[0].value == pytest.approx(zone.half)
    plain = check_samples(problem(sound))[2].dataset
    np.testing.assert_array_equal(
        fitter.dataset.torque[fitter.dataset.log == 0][:50], plain.torque[plain.log == 0][:50]
    )


def test_torques_beside_a_reference_stay_as_they_were_recorded():
    spoilt = with_torque(ZONES[SHRINKS][0])
    base, standard = base_model(operating_point().model), operating_point().standard
    values = base.base_of(standard)
    reference = Reference("earlier", base, standard, values, np.eye(len(values)))
    asked, faults, _ = check_samples(replace(problem(spoilt), reference=reference))
    assert asked.zones == ()
    assert [one.cause for one in faults] == ["torque_dead_zone"]


def lost_at_small_torques() -> JointLog:
    """Lose eleven samples at each of six passages through zero, and none at the others."""

    def lost(torque: np.ndarray) -> np.ndarray:
        passages = np.flatnonzero(np.diff(np.sign(np.convolve(torque, np.ones(9), "same"))))[2:-2]
        chosen = passages[:: max(len(passages) // 6, 1)][:6]
        near = np.abs(np.arange(len(torque))[:, None] - chosen).min(axis=1) <= 5
        return np.where(near, 0.0, torque)

    return with_torque(lost)


def test_zeros_beside_which_the_model_misses_no_torque_are_no_dead_zone():
    log = lost_at_small_torques()
    (zone,) = dead_zones(looked_at(log))
    assert zone.shortfall == zone.half
    asked, faults, _ = check_samples(problem(log))
    assert asked.zones == ()
    assert faults == []


STEP = 2.0


def cut_off(torque: np.ndarray) -> np.ndarray:
    return STEP * np.trunc(torque / STEP)


def test_a_channel_that_cuts_off_what_is_below_its_step_gets_half_a_step_back():
    asked, (fault,), _ = check_samples(problem(with_torque(cut_off)))
    (zone,) = asked.zones
    assert (zone.joint, zone.half, zone.shortfall) == (0, pytest.approx(STEP), pytest.approx(0.5 * STEP))
    assert fault.confidence > 0.9
    assert "cuts off what is below its step of 2 N m" in fault.statement


def test_steps_that_a_file_holds_with_few_digits_are_the_same_steps():
    (zone,) = check_samples(problem(with_torque(lambda torque: np.round(0.7071 * cut_off(torque), 2))))[
        0
    ].zones
    assert zone.half == pytest.approx(0.7071 * STEP, rel=1e-3)


def between_samples(torque: np.ndarray) -> np.ndarray:
    """Round coarsely, and interpolate halfway between samples as for other stamps: odd halves become rare."""
    coarse = STEP * np.round(torque / STEP)
    return 0.5 * (coarse + np.roll(coarse, 1))


@pytest.mark.parametrize(("change", "zones"), [(cut_off, 1), (between_samples, 0)])
def test_zeros_tell_a_cut_by_all_values_beside_them(change, zones):
    looked = looked_at(with_torque(change))
    assert len(list(cut_channels(looked, np.zeros_like(looked.torque)))) == zones


@pytest.mark.parametrize("change", [np.round, np.floor], ids=["rounded", "cut downward"])
def test_torques_that_err_to_either_side_are_cut_off_nowhere(change):
    asked, faults, _ = check_samples(problem(with_torque(lambda torque: STEP * change(torque / STEP))))
    assert asked.zones == ()
    assert faults == []
