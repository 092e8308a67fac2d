"""Give what a hypothesis leaves of the measured torque, at all rows of the data set."""

from collections.abc import Iterable

import numpy as np

from ...arrays import JointSeries, JointVector
from ..regression.rows import append_columns
from ..thresholds.checks import VERDICT
from .fitter import HypothesisFitter
from .hypothesis import Hypothesis


def residual(fitter: HypothesisFitter, under: Hypothesis, without: Iterable[int] = ()) -> JointSeries:
    """Give measured minus predicted torque, stiction taken out, rows x joints, N m or N.

    Parameters
    ----------
    without
        Indices of members whose torque is left out of the prediction, all else kept as it is.
    """
    rows = append_columns(fitter.rows.everywhere, fitter.columns(under.members))
    values = under.fit.values.copy()
    for index in without:
        values[under.columns_of(index)] = 0.0
    return np.column_stack([joint.residual(values) for joint in rows])


def stiction_share(fitter: HypothesisFitter, under: Hypothesis) -> JointVector:
    """Give, per joint, the share of the residual's mean square that friction at rest accounts for.

    Less what as many arbitrary columns would take; not a number where a joint hardly moves.
    """
    shares = []
    for part in append_columns(fitter.rows.everywhere, fitter.columns(under.members)):
        count, taken = len(part.torque), part.nuisance.count
        whole = part.left(under.fit.values)
        left = part.residual(under.fit.values)
        ratio = float(left @ left) / max(float(whole @ whole), 1e-300)
        moves = taken < VERDICT.at_rest * count
        shares.append(max(1.0 - ratio * count / (count - taken), 0.0) if moves else np.nan)
    return np.array(shares)
