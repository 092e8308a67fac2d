"""Spoilt values end in a log or in an error of ours; what was answered wrongly once is not again."""

import numpy as np
import pytest

from tests.spoilt.campaign import outcome
from tests.spoilt.ways import WAYS, Table
from veritorque.core.errors import VeritorqueError
from veritorque.core.log.reader import read_log

TIME = np.arange(2500) / 250.0
SWING = np.column_stack([np.sin(3.0 * TIME), 0.4 + np.cos(2.0 * TIME + 0.3)])
TORQUE = np.column_stack([5.0 * np.cos(3.0 * TIME), np.sin(2.0 * TIME + 0.3)])


@pytest.mark.parametrize("way", sorted(WAYS))
def test_a_corrupted_log_is_read_or_refused_in_words(way, tmp_path):
    noise = 1e-3 * np.random.default_rng(3).normal(size=TORQUE.shape)
    table = WAYS[way](Table(TIME.copy(), SWING.copy(), TORQUE + noise), np.random.default_rng(7))
    path = tmp_path / "spoilt.csv"
    path.write_text(table.csv())
    assert _problem(path, table) is None


def _problem(path, table):
    """Read a log; say what is wrong with the answer."""
    try:
        log = read_log(path, mapping=table.mapping())
    except VeritorqueError as error:
        return None if error.evidence and error.remedy else f"a refusal without words: {error}"
    return None if log.joints == 2 else "joints were lost"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "number", "ways"),
    [
        # Too few rows judge the gear, which least squares sees: a spring made up for it.
        (1, 0, ("geared",)),
        (1, 60, ("cut_torque",)),
        (1, 36, ("degrees",)),
        (1, 9, ("zeros_inside",)),
        (52, 185, ("geared",)),
        # A payload of 0.003 +- 0.01 kg whose instant was known well.
        (61, 68, ()),
    ],
)
def test_nothing_false_is_named_with_confidence(seed, number, ways):
    found = outcome(seed, number, ways)
    assert not found.failed
    assert not found.is_wrong, found
