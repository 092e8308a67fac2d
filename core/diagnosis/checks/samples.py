"""Check the samples of logs, and give the data set in which causes are searched.

Samples are checked at a wide band. What a dead zone takes from a torque is then added: by how much the larger
torques are too small, the model tells better than the zeros do.
"""

from collections.abc import Iterator
from dataclasses import replace

from ...signals.dead_zone import DeadZone
from ..bandwidth import Fitted, limit_bandwidth
from ..causes.external_contact import ExternalContact
from ..causes.protocol import Cause
from ..causes.registry import SAMPLE_CHECKS
from ..causes.sample_check import SampleCheck, SampleFinding
from ..causes.torque_dead_zone import TorqueDeadZone, dead_zones, zone_findings
from ..dataset.dataset import Dataset, build_dataset
from ..dataset.refusals import refuse_too_little, refuse_unjudged
from ..problem import DiagnosisProblem
from ..result import Finding
from ..search.fitter import HypothesisFitter, hypothesis_fitter
from ..search.residuals import residual
from .clipped_channel import ClippedChannel, clipped_channels
from .contact_at_rest import contacts_at_rest
from .cut_torque import cut_channels
from .findings import sample_finding
from .holdout_outliers import Explained, with_typical_holdout
from .zone_width import refined_zones

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
    zones = _zones(problem, wide[0], dataset, plain)
    # A reference was fitted to torques as they were recorded, whose channels may have had the same zones.
    known = tuple(zone for zone in zones if zone.is_known)
    if known and problem.reference is None:
        problem = replace(problem, zones=known)
        _, dataset, plain = _limited(problem)
    fitter = replace(plain[0], dataset=dataset)
    typical = with_typical_holdout(dataset, plain, lambda other: _plain_fit(fitter.with_dataset(other)))
    found = fitter if typical is dataset else fitter.with_dataset(typical)
    return problem, [*_faults(wide, zones, stay=problem.reference is not None)], found


def _zones(
    problem: DiagnosisProblem, wide: Dataset, dataset: Dataset, plain: Explained
) -> tuple[DeadZone, ...]:
    """Find dead zones and channels that cut off torques, as wide as zeros and model have them."""
    dead = dead_zones(wide)
    known = {(zone.log, zone.joint) for zone in dead}
    cut = [zone for zone in cut_channels(dataset, residual(*plain)) if (zone.log, zone.joint) not in known]
    zones = (*dead, *cut)
    if not zones:
        return ()
    _, restored, explained = _limited(replace(problem, zones=zones))
    return refined_zones(zones, restored, explained)


def _faults(wide: Fitted, zones: tuple[DeadZone, ...], *, stay: bool) -> Iterator[Finding]:
    """State what is wrong with the samples: dead zones that are known, and what else is found."""
    dataset, operating_point, _ = wide
    others = (check for check in SAMPLE_CHECKS if check.id != TorqueDeadZone.id)
    found: list[tuple[SampleCheck | Cause, tuple[SampleFinding, ...]]] = [
        *((check, check.examine(dataset, operating_point)) for check in others),
        (TorqueDeadZone(), zone_findings(dataset, operating_point, zones, stay=stay)),
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
