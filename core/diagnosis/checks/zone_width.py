"""Tell from the model by how much torques outside of dead zones are too small.

What one lacks has the sign of the torque, and other causes depend on that, too. All that may act on the joint
is fitted beside it.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...numerics.distributions import normal_tail
from ...signals.dead_zone import EVEN, DeadZone
from ..causes.registry import CAUSES
from ..dataset.dataset import Dataset, torque_sign
from ..regression.gls import fit
from ..regression.rows import Columns, append_columns
from ..search.fitter import HypothesisFitter
from ..search.hypothesis import Hypothesis
from ..thresholds.dataset import SAMPLE_CHECKS
from .holdout_outliers import Explained


def refined_zones(zones: Sequence[DeadZone], dataset: Dataset, plain: Explained) -> tuple[DeadZone, ...]:
    """Give zones as wide as zeros and model have them; without those that the model denies.

    Parameters
    ----------
    zones
        What was restored in the data set.
    """
    shrinking = [zone for zone in zones if zone.shortfall]
    refined = _refined_together(shrinking, dataset, plain) if shrinking else []
    return (*(zone for zone in zones if not zone.shortfall), *refined)


def _refined_together(zones: Sequence[DeadZone], dataset: Dataset, plain: Explained) -> list[DeadZone]:
    beside = _causes_on(*plain, {zone.joint + 1 for zone in zones})
    lacking = _lacking(zones, dataset, plain, beside)
    refined = (_refined(zone, *lacks) for zone, lacks in zip(zones, lacking, strict=True))
    return _by_recorder([zone for zone in refined if zone is not None])


def _by_recorder(zones: Sequence[DeadZone]) -> list[DeadZone]:
    """Hold channels that may cut off for as likely to as a log's surest one: one recorder wrote all."""
    surest: dict[int, float] = {}
    for zone in zones:
        if zone.cuts_off:
            surest[zone.log] = min(zone.p_value, surest.get(zone.log, 1.0))
    judged = (zone if zone.is_known else replace(zone, p_value=surest[zone.log]) for zone in zones)
    return [zone for zone in judged if zone.p_value <= EVEN]


def _lacking(
    zones: Sequence[DeadZone], dataset: Dataset, plain: Explained, beside: Sequence[Columns]
) -> list[tuple[float, float]]:
    """Fit what torques lack, beside other columns: values and deviations, N m or N."""
    fitter, _ = plain
    rows = append_columns(fitter.rows.fitted, [*beside, *_sign_columns(zones, dataset)])
    fitted = fit(rows, ordinary=fitter.ordinary_noise)
    lacking = -fitted.values[-len(zones) :]
    deviations = np.sqrt(np.diag(fitted.covariance)[-len(zones) :])
    return [(float(value), float(deviation)) for value, deviation in zip(lacking, deviations, strict=True)]


def _sign_columns(zones: Sequence[DeadZone], dataset: Dataset) -> list[Columns]:
    signs = torque_sign(dataset)
    own = [(dataset.log == zone.log)[:, None] for zone in zones]
    return [{zone.joint: signs[:, [zone.joint]] * rows} for zone, rows in zip(zones, own, strict=True)]


def _causes_on(fitter: HypothesisFitter, found: Hypothesis, joints: set[int]) -> list[Columns]:
    """Give the columns of all causes that may act on some joints (from 1) all the time, each at its best."""
    lasting = [cause for cause in CAUSES if not cause.traits.transient]
    searching = fitter.with_causes(lasting, None).linearised_at(found)
    scanned = (scored for scored in searching.scan(found) if scored.identifiable)
    sites = {(joint,) for joint in joints}
    return searching.columns([scored.candidate for scored in scanned if scored.candidate.site in sites])


def _refined(zone: DeadZone, more: float, deviation: float) -> DeadZone | None:
    """Weigh the width that zeros show with the model's, N m or N; None where the model clearly has none.

    Where torques lack nothing, zeros are those of lost samples. A width below its deviation is none.
    """
    lacking = zone.shortfall + more
    clear = lacking > SAMPLE_CHECKS.dead_clearness * deviation
    if zone.cuts_off:
        return _judged(zone, more, deviation, clear=clear)
    if deviation < zone.deviation and not clear:
        return None
    counted, fitted = zone.deviation**-2, deviation**-2
    mean, scatter = (counted * zone.half + fitted * lacking) / (counted + fitted), (counted + fitted) ** -0.5
    return replace(zone, half=mean, shortfall=mean, deviation=scatter) if mean > scatter else None


def _judged(zone: DeadZone, more: float, deviation: float, *, clear: bool) -> DeadZone | None:
    """Say whether a channel with known steps cuts off what is below; None where it does not.

    Where the model cannot tell, its zeros make it doubtful or, with a p-value of 1, do not.
    """
    if clear and abs(more) < SAMPLE_CHECKS.cut_least * zone.shortfall:
        return replace(zone, p_value=normal_tail((zone.shortfall + more) / deviation))
    if abs(more) > SAMPLE_CHECKS.dead_clearness * deviation:
        return None
    return replace(zone, p_value=EVEN if zone.p_value < SAMPLE_CHECKS.cut_chance else 1.0)
