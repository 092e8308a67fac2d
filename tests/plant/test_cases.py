"""Drawn cases: of the wanted strength, alike for the same seed, with the noise that they say."""

import json

import numpy as np
import pytest

from tests.plant import cache
from tests.plant.cases import draw, draw_clean, draw_foreign
from tests.plant.effects.registry import EFFECTS, FOREIGN
from tests.plant.known import known, known_case
from tests.plant.sensors import CORRELATION, NOISES, noise, spectrum
from tests.plant.strength import given, nameable
from veritorque.core.log.model import whole_rows


@pytest.mark.parametrize("strength", [0.3, 3.0])
@pytest.mark.parametrize(
    "cause", ["friction_stribeck", "time_delay", "joint_elasticity", "encoder_quantization", "cable_force"]
)
def test_a_case_has_the_strength_it_was_asked_for(cause, strength):
    case = draw(2, cause, strength, robot="planar-2", duration=6.0)
    (truth,) = case.truth
    assert truth.cause == cause
    assert truth.strength == pytest.approx(strength, rel=EFFECTS[cause].tolerance)
    assert truth.parameters
    assert set(truth.joints) <= set(range(1, case.log.joints + 1))


def test_the_same_seed_draws_the_same_case():
    one, other = (draw(5, robot="planar-2", duration=5.0) for _ in range(2))
    assert one.truth == other.truth
    np.testing.assert_array_equal(whole_rows(one.log).torque, whole_rows(other.log).torque)


def test_a_known_case_is_the_one_that_a_search_finds():
    asked = next(one for one in known() if json.loads(one)[1][1] == "torque_ripple")
    _, arguments, options = json.loads(asked)
    made, found = known_case(asked), draw(*arguments, **dict(options))
    for one, other in zip(made.truth, found.truth, strict=True):
        assert (one.cause, one.joints) == (other.cause, other.joints)
        assert one.strength == pytest.approx(other.strength, rel=1e-9)
    for name in ("position", "torque"):
        wanted = getattr(whole_rows(found.log), name)
        np.testing.assert_allclose(getattr(whole_rows(made.log), name), wanted, rtol=0.0, atol=1e-9)


def test_several_effects_differ_and_all_are_told():
    case = draw(3, effects=3, robot="planar-3", duration=5.0)
    causes = [truth.cause for truth in case.truth]
    assert len(set(causes)) == 3
    assert set(causes) <= set(EFFECTS)


def test_a_clean_case_hides_nothing_and_a_foreign_one_what_nobody_lists():
    assert draw_clean(4, robot="planar-2", duration=8.0).truth == ()
    assert draw_foreign(4, robot="planar-2", duration=8.0).truth[0].cause in FOREIGN


def test_a_log_has_its_length_its_rate_and_its_encoder_counts():
    case = draw_clean(1, robot="planar-2", rate_hz=500.0)
    assert case.log.rate_hz == pytest.approx(500.0)
    assert case.log.duration == pytest.approx(30.0, abs=0.01)
    counts = whole_rows(case.log).position / 1e-5
    np.testing.assert_allclose(counts, np.round(counts), atol=1e-6)


@pytest.mark.parametrize("kind", NOISES)
def test_noise_has_unit_power_and_the_spectrum_it_says(kind):
    drawn = noise(kind, (100_000, 2), 250.0, np.random.default_rng(0))
    assert np.sqrt(np.mean(drawn**2)) == pytest.approx(1.0, abs=0.05)
    frequency = np.fft.rfftfreq(len(drawn), 1.0 / 250.0)
    power = np.mean(np.abs(np.fft.rfft(drawn, axis=0)) ** 2, axis=1) / len(drawn)
    for low, high in ((0.5, 5.0), (5.0, 20.0)):
        inside = (frequency > low) & (frequency < high)
        ratio = np.mean(power[inside] / spectrum(kind, frequency[inside], 250.0))
        assert ratio == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("kind", CORRELATION)
def test_autoregressive_noise_remembers_as_much_as_it_says(kind):
    drawn = noise(kind, (200_000, 1), 250.0, np.random.default_rng(1))[:, 0]
    assert np.corrcoef(drawn[1:], drawn[:-1])[0, 1] == pytest.approx(CORRELATION[kind], abs=0.01)


def test_the_oracle_names_from_about_twenty_one_and_loses_what_another_effect_takes():
    assert not nameable(20.5)
    assert nameable(21.5)
    one, other = np.array([3.0, 4.0]), np.array([0.0, 1.0])
    assert given(one, []) == pytest.approx(25.0)
    assert given(one, [other]) == pytest.approx(9.0)


def test_a_kept_case_comes_back_whole_and_is_drawn_but_once(tmp_path, monkeypatch):
    monkeypatch.setattr(cache, "FOLDER", tmp_path)
    drawn = []

    def counted(seed, cause, *, robot, duration):
        drawn.append(seed)
        return draw(seed, cause, robot=robot, duration=duration)

    first, second = (
        cache.kept(counted, 2, "friction_temperature", robot="planar-2", duration=6.0) for _ in range(2)
    )
    assert drawn == [2]
    assert second.truth == first.truth
    assert np.array_equal(second.believed.gravity, first.believed.gravity)
    for one, other in zip(
        vars(whole_rows(first.log)).values(), vars(whole_rows(second.log)).values(), strict=True
    ):
        np.testing.assert_array_equal(one, other)
