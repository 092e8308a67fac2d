"""The short form of `make fuzz`: whatever is done to a file, reading it gives a log or an error of ours."""

import random

import pyarrow as pa
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.fuzz import campaign
from tests.fuzz.campaign import case, read, run
from tests.fuzz.mutation import WITHIN, spoilt
from tests.fuzz.seeds import seeds

RUNS = 150
FORMS = tuple(seeds())
SURVIVING = tuple(form for form in FORMS if form != "MATLAB v5")
"""Formats whose libraries have not been seen to crash: they may be read in the tests' own process."""


@pytest.mark.parametrize("form", FORMS)
def test_sound_files_are_accepted(form, tmp_path):
    for content in seeds()[form]:
        (tmp_path / "upload").write_bytes(content)
        assert read(tmp_path / "upload") == "accepted"


@pytest.mark.parametrize("form", FORMS)
def test_corrupted_files_end_in_a_log_or_an_error_of_ours(form, tmp_path):
    """A reader may die, since it is alone in its process; see test_inspector for what is answered then."""
    tally = run(form, runs=RUNS, seed=1, folder=tmp_path)
    assert tally.runs == RUNS
    assert (tally.untyped, tally.hung) == ([], [])
    assert tally.endings["refused"] > RUNS // 3  # the files are indeed spoilt
    assert tally.endings["accepted"] > RUNS // 100  # and not beyond recognition
    assert len(tally.deaths) < RUNS // 20


@settings(max_examples=75)
@given(form=st.sampled_from(SURVIVING), chance=st.randoms(use_true_random=False))
def test_a_file_corrupted_by_hypothesis_ends_in_a_log_or_an_error_of_ours(form, chance, tmp_path_factory):
    path = tmp_path_factory.getbasetemp() / "upload"
    path.write_bytes(spoilt(form, seeds()[form], chance))
    assert read(path) in {"accepted", "refused", "out of memory"}  # the reader's own bound, which it tells


@pytest.mark.parametrize("form", FORMS)
def test_a_case_is_the_same_file_again(form):
    assert case(form, 3, 17) == case(form, 3, 17) != case(form, 3, 18)


@pytest.mark.parametrize("form", FORMS)
def test_spoiling_within_spoils(form):
    content = seeds()[form][-1]
    spoilt_ones = [WITHIN[form](content, random.Random(seed)) for seed in range(8)]  # noqa: S311  (repeatable)
    assert sum(one != content for one in spoilt_ones) > len(spoilt_ones) // 2


def test_an_error_that_is_not_ours_a_crash_and_a_hang_are_told_apart(tmp_path, monkeypatch):
    import os
    import signal
    import time

    def reading(path):
        number = int.from_bytes(path.read_bytes(), "big")
        if number == 3:
            raise KeyError(number)
        if number == 5:
            os.kill(os.getpid(), signal.SIGSEGV)
        if number == 7:
            time.sleep(60.0)
        return "refused"

    monkeypatch.setattr(campaign, "HANG_S", 0.5)
    monkeypatch.setattr(campaign, "read", reading)
    monkeypatch.setattr(campaign, "case", lambda form, seed, number: bytes([number]))
    tally = run("CSV", runs=10, seed=1, folder=tmp_path)
    assert (tally.untyped, tally.deaths, tally.hung) == ([3], [(5, signal.SIGSEGV)], [7])
    assert tally.runs == 10


@pytest.fixture(autouse=True)
def memory_of_the_system():
    """Take memory as the service's readers do, so that the limit means what it says."""
    before = pa.default_memory_pool()
    pa.set_memory_pool(pa.system_memory_pool())
    yield
    pa.set_memory_pool(before)
