"""What the contract allows is answered as it says, what it forbids is refused, and nothing is a 5xx.

The short form of `make contract`.
"""

import re

import pytest

from tests.contract.__main__ import examine

ASKED, GENERATED = 200, 1400
"""Cases that are asked for, and those that come of it: some are sent however few are asked for."""


@pytest.mark.slow
def test_fourteen_hundred_requests_and_more_find_no_breach_of_the_contract(tmp_path):
    done = examine(tmp_path, cases=ASKED, seed=1)
    assert done.returncode == 0, done.stdout[-5000:] + done.stderr
    generated = re.search(r"(\d+) generated", done.stdout)
    assert generated is not None
    assert int(generated[1]) >= GENERATED
