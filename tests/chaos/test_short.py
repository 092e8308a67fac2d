"""The short form of killing and freezing, with fewer workers; `make chaos` is the long one."""

import pytest

from tests.app.postgres import cluster, new_database
from tests.chaos.run import chaos


@pytest.mark.slow
def test_no_job_is_lost_or_double_when_processes_are_killed_and_frozen():
    figures, failures = chaos(jobs=10, kills=4, freezes=1, seed=5, workers=2, tell=print)
    assert sum(failures.kills.values()) >= 4
    assert min(failures.kills.values()) >= 1
    assert failures.freezes >= 1
    assert figures.clean, figures


@pytest.mark.slow
def test_no_job_is_lost_or_double_on_postgresql():
    with cluster() as folder:
        url = new_database(folder)
        figures, failures = chaos(jobs=10, kills=4, freezes=0, seed=6, url=url, workers=1, tell=print)
    assert sum(failures.kills.values()) >= 4
    assert min(failures.kills.values()) >= 1
    assert figures.clean, figures
