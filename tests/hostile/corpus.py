"""Send every hostile file to the service and note what came of it."""

import time
from dataclasses import dataclass
from typing import Any

from starlette.testclient import TestClient

from tests.hostile import hdf5, matlab, npz, parquet, recordings, text
from tests.hostile.specimen import SECRET_TEXT, SPECIMENS, Place, Specimen
from tests.hostile.watch import Openings, Readers

CHAPTERS = (hdf5, matlab, npz, parquet, recordings, text)
"""Importing these fills `SPECIMENS`."""
MAPPING = '{"profile": "ros-jointstate"}'
"""It changes nothing for other files, whose columns have default names."""
MOST_SECONDS, MOST_MB = 2.0, 256.0
MOST_OF_SOUND = 15.0
"""How many times as long as a sound log a file may take where the machine is too busy to count seconds."""


@dataclass(frozen=True)
class Treatment:
    """Hold how the service treated one file, and what a sound log took beside it if that was late, s.

    The seconds are those that the reading process did not wait for a processor.
    """

    label: str
    bytes: int
    status: int
    cause: str
    seconds: float
    sound_seconds: float
    peak_mb: float
    openings: int
    leaked: bool

    @property
    def broken(self) -> list[str]:
        """Name the promises that were not kept."""
        kept = {
            "answered by 4xx": 400 <= self.status < 500,
            f"in {MOST_SECONDS:g} s": self.seconds <= max(MOST_SECONDS, MOST_OF_SOUND * self.sound_seconds),
            f"in {MOST_MB:g} MB": self.peak_mb <= MOST_MB,
            "opened nothing else": self.openings == 0,
            "told no secret": not self.leaked,
        }
        return [promise for promise, holds in kept.items() if not holds]


def warm_up(client: TestClient) -> None:
    """Let the service load what reads, as it does on its own in the first second."""
    client.post("/v1/logs", content=b"time\n", headers={"Content-Type": "text/csv"})


def treat(client: TestClient, specimen: Specimen, place: Place) -> Treatment:
    """Make a file, upload it, and see what happens."""
    content = specimen.make(place)
    openings = Openings(place.secret, place.secret_hdf5)
    with Readers() as readers:
        answer, seconds = _uploaded(client, content)
    seconds -= readers.waited_s
    opened = openings.count()
    openings.close()
    return Treatment(
        label=specimen.label,
        bytes=len(content),
        status=answer.status_code,
        cause=answer.json().get("cause", "accepted"),
        seconds=seconds,
        sound_seconds=_uploaded(client, text.table())[1] if seconds > MOST_SECONDS else 0.0,
        peak_mb=readers.peak_mb,
        openings=opened,
        leaked=SECRET_TEXT in answer.content,
    )


def _uploaded(client: TestClient, content: bytes) -> tuple[Any, float]:
    begin = time.perf_counter()
    answer = client.post(
        "/v1/logs",
        params={"mapping": MAPPING},
        content=content,
        headers={"Content-Type": "application/octet-stream"},
    )
    return answer, time.perf_counter() - begin


__all__ = ["CHAPTERS", "SPECIMENS", "Treatment", "treat", "warm_up"]
