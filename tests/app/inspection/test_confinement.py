"""A confined process can do nothing but read its file; each deed was possible before."""

import multiprocessing
import socket
from pathlib import Path

import pytest

from veritorque.app.inspection.confinement import MEGABYTE, Budget, can_hide_files, confine

PLENTY = Budget(10.0, 10.0, 500 * MEGABYTE)
NEEDS_LANDLOCK = pytest.mark.skipif(not can_hide_files(), reason="this kernel has no Landlock")


def attempt(pipe, folder, budget, deed):
    """Say whether a deed succeeds before and after."""
    before = succeeds(deed, folder)
    if budget is not None:
        confine(folder / "upload", budget)
    pipe.send((before, succeeds(deed, folder)))


def succeeds(deed, folder):
    try:
        deed(folder)
    except (OSError, MemoryError):
        return False
    return True


def tried(deed, folder, budget=PLENTY):
    (folder / "upload").write_bytes(b"mine")
    (folder / "other").write_bytes(b"of another tenant")
    context = multiprocessing.get_context("forkserver")
    ours, theirs = context.Pipe(duplex=False)
    process = context.Process(target=attempt, args=(theirs, folder, budget, deed))
    process.start()
    theirs.close()
    seen = ours.recv()
    process.join()
    return seen


def read_own(folder):
    (folder / "upload").read_bytes()


def read_other(folder):
    (folder / "other").read_bytes()


def read_system(_folder):
    Path("/etc/passwd").read_bytes()


def list_folder(folder):
    list(folder.iterdir())


def write_beside(folder):
    (folder / "new").write_bytes(b"x")


def overwrite_own(folder):
    (folder / "upload").write_bytes(b"mine")


def remove_other(folder):
    (folder / "other").unlink()
    (folder / "other").touch()


def take_a_gigabyte(_folder):
    bytearray(1 << 30)


def listen(_folder):
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))


def import_lazily(_folder):
    import scipy.optimize  # noqa: F401 - only whether it can be


@pytest.mark.parametrize("deed", [read_own, import_lazily])
def test_reading_the_file_and_loading_libraries_stays_possible(tmp_path, deed):
    assert tried(deed, tmp_path) == (True, True)


@NEEDS_LANDLOCK
@pytest.mark.parametrize("deed", [read_other, read_system, list_folder, remove_other, listen])
def test_what_reading_a_file_does_not_need_is_impossible(tmp_path, deed):
    assert tried(deed, tmp_path) == (True, False)


@pytest.mark.parametrize("deed", [write_beside, overwrite_own, take_a_gigabyte])
def test_writing_and_taking_much_memory_is_impossible_on_any_kernel(tmp_path, deed):
    assert tried(deed, tmp_path) == (True, False)


def test_without_confinement_all_of_it_is_possible(tmp_path):
    assert tried(read_other, tmp_path, budget=None) == (True, True)
