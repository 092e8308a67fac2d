"""A finding is doubtful where a dead zone of the torque, or another set-up, accounts for more."""

from dataclasses import replace

import numpy as np
import pytest

from tests.core.diagnosis.scenes import eventful_scene
from veritorque.core.diagnosis.causes.external_contact import ExternalContact
from veritorque.core.diagnosis.causes.friction_load_dependent import FrictionLoadDependent
from veritorque.core.diagnosis.causes.protocol import Cause, Site
from veritorque.core.diagnosis.causes.sample_check import SampleFinding
from veritorque.core.diagnosis.causes.time_delay import TimeDelay
from veritorque.core.diagnosis.causes.torque_dead_zone import TorqueDeadZone
from veritorque.core.diagnosis.checks.findings import sample_finding
from veritorque.core.diagnosis.checks.one_size import SEVERAL
from veritorque.core.diagnosis.checks.reservations import (
    beside_another_setup,
    beside_dead_zones,
    beside_mixed_channels,
    beside_unknown_signs,
)
from veritorque.core.diagnosis.checks.spring_resonance import beside_what_swings
from veritorque.core.diagnosis.result import Evidence, Finding, Gain, UnnamedPattern
from veritorque.core.diagnosis.search.hypothesis import Candidate
from veritorque.core.diagnosis.thresholds.checks import CONFIDENCE
from veritorque.core.log.model import Defect

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
    both = [found(cause, site, 0.3), found(TorqueDeadZone(), (zone,), share)]
    limited, dead = beside_dead_zones(both, restored=False)
    assert beside_dead_zones(both, restored=True) == both
    assert dead.confidence == pytest.approx(SURE)
    assert limited.confidence == pytest.approx(0.5 if doubtful else SURE)


@pytest.mark.parametrize("restored", [True, False])
def test_beside_a_zone_that_a_channel_may_have_findings_on_its_joint_are_doubtful(restored):
    own, other = (found(FrictionLoadDependent(), (joint,), 0.9) for joint in (2, 3))
    zone = replace(found(TorqueDeadZone(), (2,), 0.1), confidence=CONFIDENCE.doubtful)
    limited = beside_dead_zones([own, other, zone], restored=restored)
    assert [one.confidence for one in limited] == pytest.approx([0.5, SURE, 0.5])


@pytest.mark.parametrize(
    ("statistic", "mixes", "doubtful"), [(300.0, True, True), (100.0, True, False), (300.0, False, False)]
)
def test_channels_that_read_each_other_show_no_cause(statistic, mixes, doubtful):
    own, zone = found(FrictionLoadDependent(), (2,), 0.3), found(TorqueDeadZone(), (3,), 0.1)
    pattern = UnnamedPattern(1, "shares", statistic, -60.0, mixes_channels=mixes)
    limited = beside_mixed_channels([own, zone], pattern, 200.0)
    assert [one.confidence for one in limited] == pytest.approx([0.5 if doubtful else SURE, SURE])
    assert beside_mixed_channels([own], None, 200.0) == [own]


@pytest.mark.parametrize(("kind", "doubtful"), [("unknown_sign", True), ("standstill", False)])
def test_beside_a_torque_that_may_be_a_magnitude_no_search_is_sure_of_a_cause(kind, doubtful):
    dataset = eventful_scene().dataset
    motion = dataset.motions[0]
    log = replace(motion.log, defects=(Defect(kind, "torque", 3, 1, (), "made up"),))
    own, zone = found(FrictionLoadDependent(), (2,), 0.3), found(TorqueDeadZone(), (3,), 0.1)
    limited = beside_unknown_signs([own, zone], replace(dataset, motions=(replace(motion, log=log),)))
    assert [one.confidence for one in limited] == pytest.approx([0.5 if doubtful else SURE, SURE])
    assert ("torques of unknown sign" in {one.statistic for one in limited[0].evidence}) == doubtful


@pytest.mark.parametrize(("statistic", "doubtful"), [(SEVERAL, True), ("likelihood ratio", False)])
def test_what_explains_less_than_a_finding_of_several_sizes_is_named_with_reserve(statistic, doubtful):
    delay = replace(found(TimeDelay(), (), 0.5), evidence=(Evidence("made up", statistic, 1e-9),))
    less, more, zone = (
        found(FrictionLoadDependent(), (2,), 0.3),
        found(FrictionLoadDependent(), (3,), 0.7),
        found(TorqueDeadZone(), (3,), 0.1),
    )
    limited, alone = beside_what_swings([delay, less, more, zone])
    expected = [0.5, 0.5, SURE, SURE] if doubtful else [SURE] * 4
    assert [one.confidence for one in limited] == pytest.approx(expected)
    assert not alone
    assert beside_what_swings([delay, less])[1] == doubtful


GAINED = 0.2
"""Mean logarithm of the joints' errors that the finding of the next test gains."""


def test_a_finding_that_gains_nothing_stands_where_no_other_set_up_is_better():
    ones = np.ones(3)
    gain = Gain(ones, 1.1 * ones, -10.0 * ones, -10.0, (-12.0, -8.0))
    own = replace(found(ExternalContact(), (3,), 0.3), gain=gain)
    assert beside_another_setup([own], 0.0) == (own,)


@pytest.mark.parametrize(
    ("promising", "joins", "doubtful"),
    [
        (0.0, True, False),
        (0.9 * GAINED, True, False),
        (1.1 * GAINED, True, True),
        (1.1 * GAINED, False, False),
    ],
    ids=["no other set-up", "a worse one", "a better one", "a better one beside faulty samples"],
)
def test_what_another_set_up_explains_better_is_named_with_reserve(promising, joins, doubtful):
    before = np.array([1.0, 2.0, 0.0])
    gain = Gain(before, before * np.exp([-3.0 * GAINED, 0.0, 0.0]), np.zeros(3), 0.0, (0.0, 0.0))
    own = replace(found(FrictionLoadDependent(), (1,), 0.3), gain=gain)
    own = own if joins else replace(own, member=None)
    (said,) = beside_another_setup([own], promising)
    assert said.confidence == pytest.approx(CONFIDENCE.doubtful if doubtful else SURE)
    assert ("another set-up" in {one.statistic for one in said.evidence}) == doubtful
