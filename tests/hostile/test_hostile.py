"""Whatever is uploaded, the service answers 4xx, soon, in bounded memory, and opens nothing else."""

import h5py
import numpy as np
import pytest

from tests.app.conftest import service
from tests.core.log.recordings import write_bag, write_mcap, write_sqlite
from tests.hostile.corpus import MAPPING, SPECIMENS, treat, warm_up
from tests.hostile.hdf5 import written as hdf5
from tests.hostile.npz import Trap, archive, array_bytes
from tests.hostile.parquet import constant
from tests.hostile.recordings import sound as recording
from tests.hostile.specimen import SECRET_TEXT, Place, motion
from tests.hostile.text import table
from tests.hostile.watch import Openings

TRIES = 3
"""How often a file may be sent until it is refused in time: the machine may be busy otherwise."""


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    place = Place(tmp_path_factory.mktemp("outside"))
    place.lay_out()
    return place


@pytest.fixture(scope="module")
def client(tmp_path_factory):
    with service(tmp_path_factory.mktemp("data")) as client:
        warm_up(client)
        yield client


def test_there_are_enough_files_and_no_name_stands_twice():
    assert len({specimen.label for specimen in SPECIMENS}) == len(SPECIMENS) >= 80


@pytest.mark.parametrize("specimen", SPECIMENS, ids=lambda specimen: specimen.label)
def test_a_hostile_file_is_refused_soon_in_little_memory_and_leads_nowhere(client, place, specimen):
    for _ in range(TRIES):
        treatment = treat(client, specimen, place)
        if not treatment.broken:
            break
    assert treatment.broken == [], treatment
    assert not (place.folder / "written").exists()


def test_the_same_log_without_the_change_is_taken(client, place):
    arrays = archive({f"{name}.npy": array_bytes(values) for name, values in motion().items()})
    for content in (
        hdf5(place, lambda file: None),
        arrays,
        table(),
        recording(write_mcap),
        recording(write_sqlite),
        recording(write_bag),
    ):
        answer = client.post(
            "/v1/logs",
            params={"mapping": MAPPING},
            content=content,
            headers={"Content-Type": "application/octet-stream"},
        )
        assert answer.status_code == 201, answer.text


def test_an_opening_would_have_been_seen_and_the_secret_is_worth_stealing(place):
    link = h5py.ExternalLink(place.secret_hdf5, "q")
    (place.folder / "control.h5").write_bytes(
        hdf5(place, lambda f: f.__setitem__("q_1", link), without="q_1")
    )
    openings = Openings(place.secret, place.secret_hdf5)
    with h5py.File(place.folder / "control.h5") as file:
        np.testing.assert_array_equal(file["q_1"][()], motion()["q_1"])
    assert openings.count() > 0
    openings.close()
    assert SECRET_TEXT in place.secret.read_bytes()


def test_a_pickle_would_have_been_seen(place):
    trap = Trap(place.folder / "control")
    opened, arguments = trap.__reduce__()
    opened(*arguments).close()
    assert (place.folder / "control").exists()


def test_rows_are_counted_in_the_footer_against_the_bytes_there_are(client):
    content = constant(4_900_000, 7, ("time", "q_1", "tau_1"))
    answer = client.post("/v1/logs", content=content, headers={"Content-Type": "application/octet-stream"})
    assert "more numbers than its bytes can hold" in answer.json()["cause"]
    assert answer.json()["evidence"]["unpacked_bytes"] == 8 * 4_900_000
