"""Check the samples of logs, and give the data set in which causes are searched.

Samples are checked at a wide band. What a dead zone takes from a torque is then added: by how much the larger
torques are too small, the model tells better than the zeros do.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from ...signals.dead_zone import DeadZone
from ..bandwidth import Fitted, limit_bandwidth
from ..causes.external_contact import ExternalContact
from ..causes.protocol import Cause
from ..causes.registry import CAUSES, SAMPLE_CHECKS
from ..causes.sample_check import SampleCheck, SampleFinding
from ..causes.torque_dead_zone import TorqueDeadZone, dead_zones, zone_findings
from ..dataset.dataset import Dataset, build_dataset, torque_sign
from ..dataset.refusals import refuse_too_little, refuse_unjudged
from ..problem import DiagnosisProblem
from ..regression.gls import fit
from ..regression.rows import Columns, append_columns
from ..result import Finding
from ..search.fitter import HypothesisFitter, hypothesis_fitter
from ..search.hypothesis import Hypothesis
from ..thresholds import dataset as thresholds
from .clipped_channel import ClippedChannel, clipped_channels
from .contact_at_rest import contacts_at_rest
from .findings import sample_finding
from .holdout_outliers import Explained, with_typical_holdout

Limited = tuple[Fitted, Dataset, Explained]
"""A fit on a wide band, the data set of the band that noise of the positions leaves, and the fit there."""


def check_samples(problem: DiagnosisProblem) -> tuple[DiagnosisProblem, list[Finding], HypothesisFitter]:
    """Give the problem with its dead zones, what is wrong with the samples, and a fitter without causes.

    Raises
    ------
    ExcitationError
        If the logs hold too little motion for a fit.
    """
    wide, dataset, plain = _limited(problem)
    zones = dead_zones(wide[0])
    # A reference was fitted to torques as they were recorded, whose channels may have had the same zones.
    if zones and problem.reference is None:
        zones = _refined_zones(zones, _limited(replace(problem, zones=zones)))
        problem = replace(problem, zones=zones)
        _, dataset, plain = _limited(problem) if zones else (wide, dataset, plain)
    fitter = replace(plain[0], dataset=dataset)
    typical = with_typical_holdout(dataset, plain, lambda other: _plain_fit(fitter.with_dataset(other)))
    found = fitter if typical is dataset else fitter.with_dataset(typical)
    return problem, [*_faults(wide, zones)], found


def _faults(wide: Fitted, zones: tuple[DeadZone, ...]) -> Iterator[Finding]:
    """State what is wrong with the samples: dead zones that are known, and what else is found."""
    dataset, operating_point, _ = wide
    others = (check for check in SAMPLE_CHECKS if check.id != TorqueDeadZone.id)
    found: list[tuple[SampleCheck | Cause, tuple[SampleFinding, ...]]] = [
        *((check, check.examine(dataset, operating_point)) for check in others),
        (TorqueDeadZone(), zone_findings(dataset, operating_point, zones)),
        (ExternalContact(), contacts_at_rest(dataset, operating_point)),
        (ClippedChannel(), clipped_channels(dataset, operating_point)),
    ]
    yield from (sample_finding(check, fault, dataset) for check, faults in found for fault in faults)


def dataset_of(problem: DiagnosisProblem, width: float) -> Dataset:
    """Give the data set of a width."""
    return build_dataset(
        problem.model,
        problem.logs,
        held_out=problem.held_out,
        blocks=problem.blocks,
        width=width,
        zones=problem.zones,
    )


def _refined_zones(zones: tuple[DeadZone, ...], limited: Limited) -> tuple[DeadZone, ...]:
    """Give the zones as wide as zeros and model have them; without those that the model denies."""
    shrinking = [zone for zone in zones if zone.shrinks]
    widths = _fitted_widths(shrinking, limited) if shrinking else []
    refined = (_refined(zone, *width) for zone, width in zip(shrinking, widths, strict=True))
    others = (zone for zone in zones if not zone.shrinks)
    return (*others, *(zone for zone in refined if zone is not None))


def _fitted_widths(zones: Sequence[DeadZone], limited: Limited) -> list[tuple[float, float]]:
    """Fit to the model by how much the torques outside of dead zones are too small, beside what was added.

    What one lacks has the sign of the torque, and other causes depend on that, too. All that may act on the
    joint is fitted beside it. Gives half widths and deviations, N m or N.
    """
    _, dataset, (fitter, found) = limited
    beside = _causes_on(fitter, found, {zone.joint + 1 for zone in zones})
    rows = append_columns(fitter.rows.fitted, [*beside, *_sign_columns(zones, dataset)])
    fitted = fit(rows, ordinary=fitter.ordinary_noise)
    lacking = fitted.values[-len(zones) :]
    deviations = np.sqrt(np.diag(fitted.covariance)[-len(zones) :])
    told = zip(zones, lacking, deviations, strict=True)
    return [(zone.half - float(more), float(deviation)) for zone, more, deviation in told]


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


def _refined(zone: DeadZone, half: float, deviation: float) -> DeadZone | None:
    """Weigh the width that zeros show with the model's, N m or N; None where the model clearly has none.

    Where torques lack nothing, zeros are those of lost samples.
    """
    if deviation < zone.deviation and half < thresholds.SAMPLE_CHECKS.dead_clearness * deviation:
        return None
    counted, fitted = zone.deviation**-2, deviation**-2
    mean = (counted * zone.half + fitted * half) / (counted + fitted)
    return replace(zone, half=mean, deviation=(counted + fitted) ** -0.5)


def _limited(problem: DiagnosisProblem) -> Limited:
    fits: list[Fitted] = []
    plain: list[Explained] = []

    def fit_at(width: float) -> Fitted:
        dataset = dataset_of(problem, width)
        refuse_too_little(dataset, problem.plan)
        refuse_unjudged(dataset, fits[0][0] if fits else dataset)
        fitter, found = _plain_fit(hypothesis_fitter(dataset, problem.plan, ()))
        plain.append((fitter, found))
        noise = tuple(joint.noise for joint in found.fit.joints)
        fits.append((dataset, fitter.linearised_at(found).operating_point, noise))
        return fits[-1]

    dataset, _, _ = limit_bandwidth(fit_at)
    return fits[0], dataset, plain[-1]


def _plain_fit(fitter: HypothesisFitter) -> Explained:
    """Fit the model without any cause, under ordinary noise where too much is left to the noise."""
    found = fitter.fit(())
    if fitter.needs_ordinary_noise(found):
        fitter = fitter.with_ordinary_noise()
        found = fitter.fit(())
    return fitter, found
