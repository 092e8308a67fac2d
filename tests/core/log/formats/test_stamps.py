"""Dates and times of day are read as recorders write them: nanoseconds, days first, counts of days."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from tests.core.log.writers import swing
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log

COLUMNS = swing(joints=2)
BEFORE_MIDNIGHT = datetime(2024, 2, 3, 23, 59, 55, tzinfo=UTC)
FORMS = {
    "nanoseconds": lambda at: at.strftime("%Y-%m-%d %H:%M:%S.%f") + "123",
    "nanoseconds in a zone": lambda at: at.strftime("%Y-%m-%dT%H:%M:%S.%f") + "123+01:00",
    "a day, dots": lambda at: at.strftime("%d.%m.%Y %H:%M:%S.%f"),
    "slashes, a month first": lambda at: at.strftime("%m/%d/%Y %H:%M:%S.%f"),
    "slashes, a year first": lambda at: at.strftime("%Y/%m/%d %H:%M:%S.%f"),
    "hours of one digit": lambda at: f"{at.hour}:{at:%M:%S.%f}",
    "milliseconds behind a colon": lambda at: f"{at:%H:%M:%S}:{at.microsecond // 1000:03d}",
    "days of a duration": lambda at: f"{(at - BEFORE_MIDNIGHT).days + at.day - 3} days {at:%H:%M:%S.%f}",
}


@pytest.mark.parametrize("form", FORMS)
def test_stamps_of_every_form_are_seconds_over_midnight_too(form, tmp_path):
    path = tmp_path / "log.csv"
    with path.open("w") as stream:
        stream.write(",".join(COLUMNS) + "\n")
        for time, *values in zip(*COLUMNS.values(), strict=True):
            at = BEFORE_MIDNIGHT + timedelta(seconds=float(time))
            stream.write(",".join([FORMS[form](at), *(f"{value:.9f}" for value in values)]) + "\n")
    time = whole_rows(read_log(path)).time
    np.testing.assert_allclose(time - time[0], COLUMNS["time"], atol=2e-6)
