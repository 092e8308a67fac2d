"""Collect the makers of hostile files: a maker takes a place with a secret and gives the bytes."""

import struct
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

ROWS = 1200
SECRET_TEXT = b"the-secret-of-another-tenant"


@dataclass(frozen=True)
class Place:
    """Give the makers a folder to work in, and files of others that no upload may lead to."""

    folder: Path

    @property
    def secret(self) -> Path:
        """Numbers that would pass as a channel of the log."""
        return self.folder / "secret.bin"

    @property
    def secret_hdf5(self) -> Path:
        return self.folder / "secret.h5"

    def lay_out(self) -> None:
        import h5py

        self.folder.mkdir(parents=True, exist_ok=True)
        numbers = motion()["q_1"]
        self.secret.write_bytes(numbers.tobytes() + SECRET_TEXT)
        with h5py.File(self.secret_hdf5, "w") as file:
            file["q"] = numbers
            file["text"] = SECRET_TEXT.decode()


Maker = Callable[[Place], bytes]


@dataclass(frozen=True)
class Specimen:
    """Name one hostile file and make it; the name says what it tries."""

    form: str
    name: str
    make: Maker

    @property
    def label(self) -> str:
        return f"{self.form}: {self.name}"


SPECIMENS: list[Specimen] = []


def hostile(form: str) -> Callable[[Maker], Maker]:
    """Register a maker under its format and its own name."""

    def register(make: Maker) -> Maker:
        SPECIMENS.append(Specimen(form, make.__name__.strip("_").replace("_", " "), make))
        return make

    return register


def motion() -> dict[str, np.ndarray]:
    """Give a sound log of two joints: whatever is refused is refused for what is done to it."""
    time = np.arange(ROWS) / 200.0
    columns = {"time": time}
    for joint in (1, 2):
        columns[f"q_{joint}"] = np.sin(2.0 * joint * time) + 0.3 * np.sin(5.1 * time + joint)
    for joint in (1, 2):
        columns[f"tau_{joint}"] = 5.0 * np.cos(2.0 * joint * time) + 0.01 * np.sin(1e4 * time)
    return columns


MEGABYTE = bytes(1 << 20)


@cache
def zeros_deflated(size: int, *, head: bytes = b"", bare: bool = False) -> bytes:
    """Pack a head and so many zeros, of which a thousandth remains; a bare stream has no frame of zlib's.

    After a full flush the packer has forgotten what was before, so that each megabyte is packed alike, and
    only the first of them has to be.
    """
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    begin = packer.compress(head) + packer.flush(zlib.Z_FULL_FLUSH)
    piece = packer.compress(MEGABYTE) + packer.flush(zlib.Z_FULL_FLUSH)
    packed = begin + piece * (size >> 20) + packer.flush()
    return packed if bare else b"\x78\xda" + packed + struct.pack(">I", checksum(zlib.adler32, size, head))


def checksum(step: Callable[..., int], size: int, head: bytes) -> int:
    """Sum up a head and so many zeros by zlib's checksums."""
    total = step(head, step(b""))
    for _ in range(size >> 20):
        total = step(MEGABYTE, total)
    return total
