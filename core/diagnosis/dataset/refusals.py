"""Refuse data sets that hold too little to be diagnosed, and say why."""

from collections.abc import Sequence

import numpy as np

from ...errors import Evidence, ExcitationError
from ...log.gaps import naming_gaps
from ...log.model import JointLog
from ...regressor.columns import ColumnPlan
from ..thresholds.dataset import BAND, ROWS
from ..thresholds.residual import PREDICTION
from .dataset import Dataset


def refuse_too_little(dataset: Dataset, plan: ColumnPlan) -> None:
    """Refuse a data set in which no joint has rows enough to fit its columns.

    Raises
    ------
    ExcitationError
        If no joint has.
    """
    rows = (dataset.clear & ~dataset.held_out[:, None]).sum(axis=0)
    needed = np.array([ROWS.per_column * len(columns) for columns in plan.columns_of])
    if (rows < needed).all():
        logs = [motion.log for motion in dataset.motions]
        with naming_gaps(logs):
            raise _too_little({"instants": rows.tolist(), "needed": needed.tolist()}, logs)


def _too_little(counts: Evidence, logs: Sequence[JointLog]) -> ExcitationError:
    """Say why there are so few instants, as far as it is not for missing rows."""
    kinds = {defect.kind: defect for log in logs for defect in log.defects}
    if "jitter" in kinds:
        return ExcitationError(
            "the stamps scatter so much that speeds are mostly noise: no joint has enough instants that "
            "are surely away from reversals",
            evidence={**counts, "stamps": kinds["jitter"].statement},
            remedy="stamp every sample when it is taken, or number the samples of an even clock and "
            "divide by its rate",
        )
    return ExcitationError(
        "the log holds too little motion for a diagnosis: no joint has enough instants away from "
        "standstill and reversals",
        evidence=counts,
        remedy="record at least ten seconds in which every joint moves, at 100 Hz or more",
    )


def refuse_unjudged(dataset: Dataset, wide: Dataset) -> None:
    """Refuse an unusually narrow band in which a joint's residual cannot be judged, as it can in a wide one.

    Raises
    ------
    ExcitationError
        If there is such a joint.
    """
    rows, enough = dataset.clear.sum(axis=0), wide.clear.sum(axis=0) >= PREDICTION.least_rows
    if dataset.width < BAND.narrowest and (rows[enough] < PREDICTION.least_rows).any():
        raise ExcitationError(
            "so narrow a band leaves too few instants to judge what a model leaves",
            evidence={"instants": rows.tolist(), "needed": PREDICTION.least_rows},
            remedy="record more motion, or positions with less noise",
        )
