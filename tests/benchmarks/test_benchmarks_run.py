"""Every benchmark runs on tiny input and gives figures that mean something; speed is not judged here."""

import importlib

import numpy as np
import pytest

from benchmarks import coverage, hour, nelder_mead, regressor
from benchmarks.__main__ import NAMES
from benchmarks.demo_log import demo_log, demo_robot
from benchmarks.figures import processor_seconds
from benchmarks.running import shared_services
from benchmarks.scene import smooth_motion, yumi_arm
from veritorque.core.log.reader import read_log
from veritorque.core.study import IdentifyRequest, identify_in_full

OWN = ("hour", "coverage", "nelder_mead", "estimators")
"""Benchmarks that have tests of their own."""


@pytest.fixture(scope="module")
def shared():
    """Services that several benchmarks use, since it is not speed that is wanted here."""
    with shared_services():
        yield


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in NAMES if name not in OWN])
def test_a_benchmark_gives_named_figures(shared, name):
    figures = importlib.import_module(f"benchmarks.{name}").run(quick=True)
    assert len({figure.name for figure in figures}) == len(figures) > 0
    assert any(figure.ratio for figure in figures)


def test_the_regressor_compared_is_the_one_pinocchio_computes():
    state = smooth_motion(7).at(np.arange(100) / 250.0)
    assert regressor.difference(state) <= 1e-12


def test_the_hour_written_to_parquet_is_the_hour_that_was_meant(tmp_path):
    hour.write_log(tmp_path / "log.parquet", 1_000)
    log = read_log(tmp_path / "log.parquet")
    rows = log.source.rows(0, log.samples)
    expected = yumi_arm().torque(smooth_motion(7).at(rows.time))
    assert log.samples == 1_000
    assert np.all(np.std(rows.torque - expected, axis=0) < 0.1 * np.std(expected, axis=0))


def test_coverage_counts_standardised_errors_of_every_base_parameter():
    names, misses = coverage.standardised_errors("wls", draws=1, until=8.0)
    assert misses.shape == (1, len(names))
    assert 0.3 < np.std(misses) < 3.0


def test_the_seeds_criterion_is_the_torque_error_where_the_mass_matrix_is_positive_and_a_wall_elsewhere():
    found = identify_in_full(IdentifyRequest(demo_robot(), (demo_log(),), {"bootstrap": {"draws": 0}}))
    criterion = nelder_mead.Criterion.of(found)
    scaled = found.estimate.base / criterion.scale
    assert criterion(scaled) == pytest.approx(found.estimate.objective)
    assert criterion(-scaled) > 10.0 * found.estimate.system.cost(-found.estimate.base)


def test_processor_time_grows_with_the_work():
    work = np.random.default_rng(0).normal(size=(200, 200))
    once = processor_seconds(lambda: work @ work, repeats=3)
    tenfold = processor_seconds(lambda: [work @ work for _ in range(10)], repeats=3)
    assert tenfold > 3.0 * once
