"""Distinguish a spike of the torque channel from a contact: a spike lasts one sample, a contact many.

A filter widens a spike, so that only the raw samples distinguish the two. Source: Davies & Gather, J.
Am. Stat. Assoc. 88, 1993, for outliers against a quantile of what surrounds them.
"""

import numpy as np

from ...arrays import JointMask, JointSeries
from ...dynamics.terms.external_contact import Span
from ...log.model import JointLog
from ...signals.derivative import median
from ..thresholds.dataset import ROWS


def has_spike(log: JointLog, span: Span) -> bool:
    """Tell whether a raw sample within a span of a log is a spike of some joint's torque."""
    first = float(log.source.rows(0, 1).time[0])
    begin, end = (
        round((edge - first) * log.rate_hz)
        for edge in (span[0] - ROWS.spike_seconds, span[1] + ROWS.spike_seconds)
    )
    rows = log.source.rows(max(begin, 0), min(end, log.samples))
    effort = rows.current if rows.torque is None else rows.torque
    if effort is None or len(rows.time) <= ROWS.spike_order:
        return False
    _, spikes = _median_and_spikes(effort)
    inside = (rows.time >= span[0]) & (rows.time <= span[1])
    return bool(spikes[inside].any())


def _median_and_spikes(torque: JointSeries) -> tuple[JointSeries, JointMask]:
    """Give the running median, and mark what stands apart from it; the ends are their own."""
    reach = ROWS.spike_order // 2
    middle = torque.copy()
    middle[reach:-reach] = median(np.ascontiguousarray(torque), ROWS.spike_order)
    remainder = np.abs(torque - middle)
    usual = np.maximum(np.quantile(remainder[reach:-reach], ROWS.spike_quantile, axis=0), 1e-300)
    return middle, remainder > ROWS.spike_ratio * usual
