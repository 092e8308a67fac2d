"""Lend tests of simulated motion an arm, and a log of it that pinocchio has made."""

import numpy as np
import pytest

from tests.core.simulation.logs import logged
from tests.tools import random_bodies, random_robot


@pytest.fixture(scope="module")
def arm():
    rng = np.random.default_rng(41)
    robot = random_robot(rng, 3, prismatic=0.0)
    return robot, random_bodies(rng, 3)


@pytest.fixture(scope="module")
def motion(arm):
    return logged(*arm)
