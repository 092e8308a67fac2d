"""A finding beside a torque channel with a dead zone is doubtful where that accounts for more."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.diagnosis.scenes import eventful_scene
from veritorque.core.diagnosis.causes.external_contact import ExternalContact
from veritorque.core.diagnosis.causes.friction_load_dependent import FrictionLoadDependent
from veritorque.core.diagnosis.causes.protocol import Cause, Site
from veritorque.core.diagnosis.causes.sample_check import SampleFinding
from veritorque.core.diagnosis.causes.torque_dead_zone import TorqueDeadZone
from veritorque.core.diagnosis.checks.findings import sample_finding
from veritorque.core.diagnosis.checks.reservations import beside_dead_zones
from veritorque.core.diagnosis.result import Finding
from veritorque.core.diagnosis.search.hypothesis import Candidate

SURE = 0.97


def found(cause: Cause | TorqueDeadZone, site: Site, share: float) -> Finding:
    """Give a sure finding that explains so much."""
    shares = np.full(3, share)
    made = sample_finding(
        cause, SampleFinding(site, (), "found", 1.0, 1.0 - SURE, shares), eventful_scene().dataset
    )
    return (
        made if isinstance(cause, TorqueDeadZone) else replace(made, member=Candidate(cause, site, {}, 1.0))
    )


@pytest.mark.parametrize(
    ("cause", "site", "zone", "share", "doubtful"),
    [
        (FrictionLoadDependent(), (2,), 2, 0.8, True),
        (FrictionLoadDependent(), (2,), 2, 0.1, False),
        (FrictionLoadDependent(), (2,), 1, 0.8, False),
        (ExternalContact(), (3,), 1, 0.8, True),
        (ExternalContact(), (2,), 3, 0.8, False),
    ],
    ids=["same joint", "small zone", "another joint", "a joint that a contact loads", "one that it does not"],
)
def test_what_a_dead_zone_accounts_for_is_named_with_reserve(cause, site, zone, share, doubtful):
    limited, dead = beside_dead_zones([found(cause, site, 0.3), found(TorqueDeadZone(), (zone,), share)])
    assert dead.confidence == pytest.approx(SURE)
    assert limited.confidence == pytest.approx(0.5 if doubtful else SURE)
