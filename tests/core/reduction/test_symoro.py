"""Base parameters found by numbers are those SYMORO finds by symbols: same names, same groupings."""

import numpy as np
import pytest

from tests.core.reduction.symoro import golden, golden_table, printed
from tests.tools import shared
from veritorque.core.dynamics.model import standard_model
from veritorque.core.reduction.base import BaseModel, base_model
from veritorque.core.robot.model import RobotModel

ROBOTS = golden()
COUNTS = {"rx90": 40, "tx40": 40, "puma560": 40, "kukalwr": 48, "yumi": 48, "yumi_tilted": 50}
"""As counted in the summary that comes with the printed files; the seed paper counts 50 for a YuMi arm."""
COEFFICIENT_TOLERANCE = 1e-9
"""Of the largest coefficient, which is one: the columns are solved for one another in double precision."""


def _base(robot: RobotModel) -> BaseModel:
    return base_model(standard_model(robot, ("rigid_body", "rotor_inertia")))


@pytest.mark.parametrize("name", COUNTS)
def test_the_base_parameters_have_symoros_names_in_the_order_of_its_table(name):
    found = _base(golden_table(ROBOTS[name]).robot(ROBOTS[name]["lengths"]))
    assert list(found.names) == ROBOTS[name]["names"].split()
    assert len(found.names) == COUNTS[name]


@pytest.mark.parametrize("name", COUNTS)
def test_the_names_do_not_depend_on_the_lengths(name):
    rng = np.random.default_rng(1)
    lengths = {symbol: float(rng.uniform(0.05, 2.0)) for symbol in ROBOTS[name]["lengths"]}
    assert set(_base(golden_table(ROBOTS[name]).robot(lengths)).names) == set(ROBOTS[name]["names"].split())


@pytest.mark.parametrize("name", COUNTS)
def test_the_kept_tables_are_what_symoro_printed(name):
    table, kept = printed(shared(f"references/symoro_{name}.txt")), golden_table(ROBOTS[name])
    assert (table.rows, table.tilted, table.names) == (kept.rows, kept.tilted, kept.names)


@pytest.mark.parametrize("name", COUNTS)
def test_the_groupings_are_symoros_equations(name):
    table, lengths = printed(shared(f"references/symoro_{name}.txt")), ROBOTS[name]["lengths"]
    found = _base(table.robot(lengths))
    standard = tuple(parameter.name for parameter in found.model.parameters)
    expected = table.coefficients(lengths, standard)
    assert set(found.names) == set(expected)
    for row, base in zip(found.grouping, found.names, strict=True):
        assert np.max(np.abs(row - expected[base])) < COEFFICIENT_TOLERANCE, base
