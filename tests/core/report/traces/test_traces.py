"""What a study computed instant by instant comes back whole, and thinned without losing an extreme."""

from dataclasses import replace

import numpy as np
import pyarrow.parquet as pq
import pytest

from tests.core.estimate.worlds import log_of, planar_robot, swing, true_parameters
from veritorque.core.dynamics.model import standard_model
from veritorque.core.errors import OptionError
from veritorque.core.log.model import ArraySource, whole_rows
from veritorque.core.report.traces.layout import SIGNALS, column
from veritorque.core.report.traces.reading import View, read_traces
from veritorque.core.study import IdentifyRequest, identify

MODEL = standard_model(planar_robot())
NOISE = 0.05
OPTIONS = {"bootstrap": {"draws": 0}}
TORQUE = ("torque_filtered", "torque_estimated", "residual")


def _log(seed, seconds=20.0):
    state = swing(2, seed=seed, seconds=seconds)
    rough = NOISE * np.random.default_rng(seed).normal(size=state.position.shape)
    return replace(log_of(MODEL, true_parameters(MODEL), state, rough), sha256=f"log {seed}")


@pytest.fixture(scope="module")
def logs():
    return (_log(1), _log(2, seconds=15.0))


@pytest.fixture(scope="module")
def study(tmp_path_factory, logs):
    """The document of a study of two logs, and the file of its traces."""
    path = tmp_path_factory.mktemp("traces") / "residuals.parquet"
    return identify(IdentifyRequest(MODEL.robot, logs, OPTIONS, traces=path)), path


@pytest.fixture(scope="module")
def table(study):
    return {name: values.to_numpy() for name, values in zip(*_columns(study[1]), strict=True)}


def _columns(path):
    read = pq.read_table(path)
    return read.column_names, read.columns


def test_equal_studies_write_equal_bytes(study, logs, tmp_path):
    again = tmp_path / "again.parquet"
    identify(IdentifyRequest(MODEL.robot, logs, OPTIONS, traces=again))
    assert again.read_bytes() == study[1].read_bytes()


def test_the_document_does_not_depend_on_whether_traces_are_kept(study, logs):
    assert identify(IdentifyRequest(MODEL.robot, logs, OPTIONS)) == study[0]


@pytest.mark.parametrize(("part", "held_out"), [("fit", False), ("validation", True)])
def test_the_scores_of_the_document_are_those_of_the_rows_that_count(study, table, part, held_out):
    for row in study[0][part]:
        moving = table[column("used", row["joint"])] & ~table[column("reversal", row["joint"])]
        counts = moving & (table["held_out"] == held_out)
        residual = table[column("residual", row["joint"])][counts]
        assert len(residual) == row["samples"]
        # Traces are kept in single precision, which has seven digits.
        assert np.sqrt(np.mean(residual**2)) == pytest.approx(row["rms_residual"], rel=1e-6)


def test_filtered_torque_is_the_estimated_one_and_the_residual(table):
    for joint in (1, 2):
        filtered, estimated, residual = (table[column(signal, joint)] for signal in TORQUE)
        assert filtered == pytest.approx(estimated + residual, abs=1e-4)


def test_the_measured_torque_is_the_log_at_the_kept_instants(table, logs):
    for number, log in enumerate(logs, start=1):
        rows = whole_rows(log)
        own = table["log"] == number
        kept = np.searchsorted(rows.time, table["time"][own] - 1e-6)
        for joint in (1, 2):
            measured = table[column("torque_measured", joint)][own]
            assert np.array_equal(measured, rows.torque[kept, joint - 1].astype(np.float32))


def test_held_out_rows_are_those_of_the_spans_that_the_document_names(study, table):
    inside = np.zeros(len(table["time"]), dtype=bool)
    for span in study[0]["held_out"]:
        own = table["log"] == span["log"]
        middle, reach = 0.5 * (span["end_s"] + span["begin_s"]), 0.5 * (span["end_s"] - span["begin_s"])
        inside |= own & (abs(table["time"] - middle) <= reach + 1e-6)
    assert np.array_equal(inside, table["held_out"])


def test_a_view_of_few_points_has_all_extremes_of_its_log_and_of_no_other(study, table):
    for log in (1, 2):
        seen = read_traces(study[1], View(log, 2, TORQUE, points=40))
        assert len(seen.time) <= 40
        assert seen.rows_per_stretch > 1
        own = table["log"] == log
        for values, signal in zip(seen.values.T, TORQUE, strict=True):
            rows = table[column(signal, 2)][own]
            assert (values.min(), values.max()) == (rows.min(), rows.max())
        assert seen.extent == (table["time"][own][0], table["time"][own][-1])


def test_a_narrow_view_shows_every_row_of_it_and_one_on_either_side(study, table):
    own = table["log"] == 2
    time = table["time"][own]
    seen = read_traces(study[1], View(2, 1, ("position",), time[5], time[9]))
    assert seen.rows_per_stretch == 1
    assert np.array_equal(seen.time, time[4:11])
    assert np.array_equal(seen.values[:, 0], table["position_1"][own][4:11])


def test_rows_are_told_from_each_other_by_span_and_by_what_does_not_count(study, table):
    own = table["log"] == 1
    seen = read_traces(study[1], View(1, 1, TORQUE))
    spans = ((seen.held_out, table["held_out"][own]), (seen.left_out, ~table["used_1"][own]))
    for found, marks in spans:
        inside = np.zeros(len(marks), dtype=bool)
        for begin, end in found:
            inside |= (table["time"][own] >= begin) & (table["time"][own] <= end)
        assert np.array_equal(inside, marks)


def test_a_gap_in_the_log_is_a_gap_in_its_traces(tmp_path):
    log = _log(1, seconds=30.0)
    rows = whole_rows(log)
    later = replace(rows, time=np.where(rows.time < 15.0, rows.time, rows.time + 40.0))
    broken = replace(log, source=ArraySource(later), segments=((0, 1500), (1500, 3000)), duration=70.0)
    path = tmp_path / "residuals.parquet"
    identify(IdentifyRequest(MODEL.robot, (broken,), OPTIONS, traces=path))
    seen = read_traces(path, View(1, 1, ("residual",)))
    gaps = np.flatnonzero(np.isnan(seen.values[:, 0]))
    assert len(gaps) == 1
    assert 15.0 < seen.time[gaps[0]] < 55.0


UNKNOWN = {
    "log": (View(3, 1, TORQUE), [1, 2]),
    "joint": (View(1, 3, TORQUE), [1, 2]),
    "signal": (View(1, 1, ("residual_after",)), list(SIGNALS[:6])),
}


@pytest.mark.parametrize(("what", "view", "known"), [(what, *one) for what, one in UNKNOWN.items()])
def test_what_a_result_does_not_have_is_refused_with_what_it_has(study, what, view, known):
    with pytest.raises(OptionError, match=what) as refused:
        read_traces(study[1], view)
    assert refused.value.evidence["known"] == known


@pytest.mark.parametrize("span", [(5.0, 5.0), (7.0, 3.0), (100.0, 200.0), (-9.0, -1.0)])
def test_a_stretch_in_which_nothing_was_measured_is_refused(study, span):
    with pytest.raises(OptionError, match="nothing was measured"):
        read_traces(study[1], View(1, 1, TORQUE, *span))
