"""What a model leaves shows itself over the coordinate that it depends on, and nowhere else."""

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from veritorque.core.errors import ExcitationError
from veritorque.core.report.traces.views import read_views

ROWS, RATE_HZ = 4000, 20.0
TIME = np.arange(ROWS) / RATE_HZ
POSITION = 1.5 * np.sin(0.9 * TIME)
VELOCITY = 2.0 * np.sin(1.7 * TIME + 0.4)
NOISE = 0.1 * np.random.default_rng(3).normal(size=ROWS)


def kept(path, residual, used=None):
    """Write a file of traces of one joint, as far as views read it."""
    columns = {
        "log": np.ones(ROWS, dtype=np.int32),
        "time": TIME,
        "position_1": POSITION.astype(np.float32),
        "velocity_1": VELOCITY.astype(np.float32),
        "residual_1": residual.astype(np.float32),
        "used_1": np.ones(ROWS, dtype=bool) if used is None else used,
    }
    units = {"position_1": "rad", "velocity_1": "rad/s", "residual_1": "N m"}
    fields = [
        pa.field(name, pa.array(values).type, metadata={"unit": units.get(name, "")})
        for name, values in columns.items()
    ]
    pq.write_table(pa.table(columns, schema=pa.schema(fields)), path)
    return path


def over(views, coordinate):
    return next(one for one in views.over if one.coordinate == coordinate)


@pytest.mark.parametrize(
    ("coordinate", "effect", "other"),
    [("position", np.cos(2.0 * POSITION), "velocity"), ("velocity", np.tanh(VELOCITY / 0.3), "position")],
)
def test_a_residual_follows_the_coordinate_that_it_depends_on(tmp_path, coordinate, effect, other):
    effect = effect - effect.mean()
    views = read_views(kept(tmp_path / "traces", effect + NOISE), log=1, joint=1)
    seen, elsewhere = over(views, coordinate), over(views, other)
    shape = np.cos(2.0 * seen.centre) if coordinate == "position" else np.tanh(seen.centre / 0.3)
    shape -= shape.mean()
    # A bin of 100 rows averages noise of 0.1 to 0.01, and is as wide as the coordinate moves within it.
    assert seen.curves[0].mean == pytest.approx(shape, abs=0.12)
    assert np.std(elsewhere.curves[0].mean) < 0.5 * np.std(seen.curves[0].mean)


def test_nine_of_ten_rows_lie_within_the_band(tmp_path):
    views = read_views(kept(tmp_path / "traces", NOISE), log=1, joint=1)
    curve = over(views, "velocity").curves[0]
    # Quantiles of a normal distribution: 1.645 deviations, here of 0.1.
    assert np.mean(curve.high) == pytest.approx(0.1645, rel=0.05)
    assert np.mean(curve.low) == pytest.approx(-0.1645, rel=0.05)


def test_the_density_integrates_to_the_mean_square_and_peaks_where_the_residual_swings(tmp_path):
    swing = 0.5 * np.sin(2.0 * np.pi * 3.0 * TIME)
    (density,) = read_views(kept(tmp_path / "traces", swing + NOISE), log=1, joint=1).densities
    step = density.frequency_hz[1]
    assert density.density.sum() * step == pytest.approx(np.mean((swing + NOISE) ** 2), rel=0.05)
    assert density.frequency_hz[np.argmax(density.density)] == pytest.approx(3.0, abs=step)


def test_rows_that_do_not_count_are_not_seen(tmp_path):
    used = TIME < 100.0
    spoiled = np.where(used, NOISE, 1e3)
    views = read_views(kept(tmp_path / "traces", spoiled, used), log=1, joint=1)
    assert views.samples == used.sum()
    assert max(np.abs(one.curves[0].high).max() for one in views.over) < 1.0
    assert views.densities[0].density.max() < 1.0


def test_a_joint_of_which_nothing_counts_is_refused_with_how_little_there_is(tmp_path):
    path = kept(tmp_path / "traces", NOISE, TIME < 0.4)
    with pytest.raises(ExcitationError, match="too few") as refused:
        read_views(path, log=1, joint=1)
    assert refused.value.evidence["instants"] == 8
