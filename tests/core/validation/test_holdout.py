"""Hold held-out data to being held out: contiguous, disjoint from the fit, and scored as recomputed."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.core.estimate.worlds import log_of, planar_robot, swing, true_parameters
from veritorque.core.document.identification import Identification
from veritorque.core.dynamics.model import standard_model
from veritorque.core.errors import OptionError
from veritorque.core.log.model import JointLog, whole_rows
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.regressor.residuals import residuals
from veritorque.core.robot.description import robot_from_description
from veritorque.core.study import IdentifyRequest, identify_in_full
from veritorque.core.validation.holdout import HoldOut
from veritorque.core.validation.scores import JointScore, scores, total_percent

MODEL = standard_model(planar_robot())


def _log(seed: int, noise: float = 0.1) -> JointLog:
    state = swing(2, seed=seed)
    return log_of(
        MODEL,
        true_parameters(MODEL),
        state,
        noise * np.random.default_rng(seed).normal(size=state.position.shape),
    )


def _found(logs: tuple[JointLog, ...], **options: object) -> Identification:
    return identify_in_full(IdentifyRequest(MODEL.robot, logs, {"bootstrap": {"draws": 0}, **options}))


@given(fraction=st.floats(0.0, 0.5), blocks=st.integers(4, 200), logs=st.integers(1, 4))
def test_every_log_keeps_at_least_half_of_its_blocks_to_fit(fraction, blocks, logs):
    chosen = HoldOut(fraction, blocks).chosen(logs)
    for log in range(logs):
        held = [block for number, block in chosen if number == log]
        assert len(held) == round(fraction * blocks)
        assert len(set(held)) == len(held)
        assert 0 <= min(held, default=0) <= max(held, default=0) < blocks


def test_blocks_are_contiguous_in_time_and_do_not_overlap():
    found = _found((_log(1), _log(2)))
    for log in (0, 1):
        blocks = [block for block in found.observation.blocks if block.log == log]
        assert [block.number for block in blocks] == list(range(20))
        for before, after in pairwise(blocks):
            assert before.start <= before.end < after.start


def test_what_is_held_out_has_no_say_in_the_fit():
    clean = _log(1)
    rows = whole_rows(clean)
    options = {"validation": {"fraction": 0.25, "blocks": 4}, "filter": {"cutoff_hz": 10, "decimation": 4}}
    (held,) = [block for _, block in HoldOut(0.25, 4).chosen(1)]
    spoilt = rows.torque.copy()
    quarter = len(spoilt) // 4
    # A second on either side is left alone: the parallel filter reaches over a block's border.
    inside = slice(held * quarter + 100, (held + 1) * quarter - 100)
    spoilt[inside] += np.sin(np.arange(inside.stop - inside.start) / 5.0)[:, None]
    before = _found((clean,), **options)
    after = _found((log_from_arrays("spoilt", rows.time, rows.position, spoilt),), **options)
    np.testing.assert_allclose(after.estimate.base, before.estimate.base, rtol=1e-6, atol=1e-7)
    np.testing.assert_allclose(
        after.precision.standard_deviation, before.precision.standard_deviation, rtol=1e-4
    )
    assert after.validation[0].rms_residual > 2.0 * before.validation[0].rms_residual


def test_whole_logs_are_held_out_and_the_others_are_fitted_alone():
    together = _found((_log(1), _log(2)), validation={"logs": [2]})
    alone = _found((_log(1),), validation={"fraction": 0.0})
    np.testing.assert_allclose(together.estimate.base, alone.estimate.base, rtol=1e-9, atol=1e-10)
    assert alone.validation == ()
    assert [score.samples > 0 for score in together.validation] == [True, True]


@pytest.mark.parametrize("logs", [(0,), (3,), (1, 2), (-1,)])
def test_logs_that_do_not_exist_or_leave_nothing_to_fit_are_refused(logs):
    with pytest.raises(OptionError):
        HoldOut(logs=logs).chosen(2)


def test_whoever_holds_out_the_only_log_is_offered_a_fraction_of_it():
    with pytest.raises(OptionError, match="single log") as refusal:
        HoldOut(logs=(1,)).chosen(1)
    assert "fraction" in refusal.value.remedy


@pytest.mark.parametrize("wrong", [{"fraction": 0.6}, {"fraction": -0.1}, {"blocks": 3}, {"blocks": 201}])
def test_hold_outs_that_make_no_sense_are_refused(wrong):
    with pytest.raises(OptionError):
        HoldOut(**wrong)


@pytest.mark.parametrize("estimator", ["sdp", "irls"])
def test_scores_are_those_of_the_residuals_recomputed_sample_by_sample(estimator):
    found = _found((_log(1), _log(2)), validation={"logs": [2]}, estimator=estimator)
    for motion, listed in zip(found.motions, (found.fit, found.validation), strict=True):
        tiles = list(residuals(found.observation.plan, motion, found.estimate.base))
        residual, torque, usable = (
            np.concatenate([getattr(tile, name) for tile in tiles])
            for name in ("residual", "torque", "usable")
        )
        moving = usable & ~np.concatenate([tile.turning for tile in motion.tiles()])
        for joint, score in enumerate(listed):
            left, level = residual[moving[:, joint], joint], torque[moving[:, joint], joint]
            span = np.ptp(torque[usable[:, joint], joint])
            assert score.samples == len(left)
            assert score.rms_residual == pytest.approx(np.sqrt(np.mean(left**2)), rel=1e-8)
            assert score.rms_torque == pytest.approx(np.sqrt(np.mean(level**2)), rel=1e-8)
            assert score.nrmse_of_rms_percent == pytest.approx(100 * score.rms_residual / score.rms_torque)
            assert score.nrmse_of_range_percent == pytest.approx(100 * score.rms_residual / span)


def test_the_total_is_the_norm_of_all_residuals_over_the_norm_of_all_torques():
    found = _found((_log(1),))
    everything = tuple(range(len(found.observation.blocks)))
    parts = scores(found.observation, everything, found.estimate.base)
    left = sum(one.samples * one.rms_residual**2 for one in parts)
    torque = sum(one.samples * one.rms_torque**2 for one in parts)
    total = total_percent(found.observation, everything, found.estimate.base)
    assert total == pytest.approx(100.0 * np.sqrt(left / torque), rel=1e-9)


def test_the_total_of_a_turn_and_a_slide_adds_no_newtons_to_newton_metres():
    row = {"type": "revolute", "alpha": np.pi / 2, "d": 0.0, "r": 0.0, "theta_offset": 0.0}
    slide = {**row, "type": "prismatic"}
    model = standard_model(robot_from_description({"name": "turn and slide", "joints": [row, slide]}))
    noise = np.random.default_rng(3).normal(size=(2000, 2)) * (0.1, 2.0)
    log = log_of(model, true_parameters(model), swing(2), noise)
    found = identify_in_full(IdentifyRequest(model.robot, (log,), {"bootstrap": {"draws": 0}}))
    everything = tuple(range(len(found.observation.blocks)))
    shares = [
        one.rms_residual / one.rms_torque
        for one in scores(found.observation, everything, found.estimate.base)
    ]
    total = total_percent(found.observation, everything, found.estimate.base)
    assert total == pytest.approx(100.0 * np.sqrt(np.mean(np.square(shares))), rel=1e-9)


def test_no_blocks_score_nothing_instead_of_dividing_by_nothing():
    found = _found((_log(1),))
    assert scores(found.observation, (), found.estimate.base)[0] == JointScore(1, 0, 0.0, 0.0, 0.0, 0.0)
