"""Recognise a file's format by its first bytes, and compare that with what its name and media type claim.

The bytes decide. A claim which contradicts them is refused rather than ignored, since one of the two must be
a mistake.
"""

import codecs
from dataclasses import dataclass
from pathlib import Path

from ...errors import LogError
from .text_bytes import BYTE_ORDER_MARKS, UTF_16

HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"
UTF_32_MARKS = (codecs.BOM_UTF32_LE, codecs.BOM_UTF32_BE)
NO_CLAIM = ("", "application/octet-stream", "binary/octet-stream")


@dataclass(frozen=True)
class Form:
    """Name a format, and the media types and file suffixes under which it travels."""

    name: str
    media_types: tuple[str, ...]
    suffixes: tuple[str, ...]


DELIMITED = Form(
    "CSV",
    ("text/csv", "application/csv", "text/tab-separated-values", "text/plain", "application/vnd.ms-excel"),
    (".csv", ".tsv", ".txt", ".dat"),
)
PARQUET = Form(
    "Parquet",
    ("application/vnd.apache.parquet", "application/parquet", "application/x-parquet"),
    (".parquet", ".pq"),
)
NPZ = Form("NPZ", ("application/x-npz", "application/zip", "application/x-zip-compressed"), (".npz",))
MATLAB5 = Form("MATLAB v5", ("application/x-matlab-data", "application/matlab-mat"), (".mat",))
MATLAB7 = Form(
    "MATLAB v7.3",
    ("application/x-matlab-data", "application/matlab-mat", "application/x-hdf5", "application/x-hdf"),
    (".mat", ".h5", ".hdf5"),
)
MCAP = Form("MCAP", ("application/x-mcap", "application/mcap"), (".mcap",))
SQLITE_BAG = Form("ROS 2 bag (SQLite)", ("application/vnd.sqlite3", "application/x-sqlite3"), (".db3",))
BAG = Form("ROS bag", ("application/x-rosbag",), (".bag",))
FORMS = (DELIMITED, PARQUET, NPZ, MATLAB5, MATLAB7, MCAP, SQLITE_BAG, BAG)

_BEGINNINGS: tuple[tuple[bytes, Form], ...] = (
    (b"PAR1", PARQUET),
    (b"PK\x03\x04", NPZ),
    (b"MATLAB 7.3", MATLAB7),
    (HDF5_SIGNATURE, MATLAB7),
    (b"\x89MCAP0\r\n", MCAP),
    (b"SQLite format 3\x00", SQLITE_BAG),
    (b"#ROSBAG V2.0\n", BAG),
)
_FOREIGN: tuple[tuple[bytes, str, str], ...] = (
    (b"\x1f\x8b", "a gzip archive", "unpack it first"),
    (b"BZh", "a bzip2 archive", "unpack it first"),
    (b"\xfd7zXZ\x00", "an xz archive", "unpack it first"),
    (b"7z\xbc\xaf\x27\x1c", "a 7z archive", "unpack it first"),
    (b"\x28\xb5\x2f\xfd", "a Zstandard archive", "unpack it first"),
    (b"ARROW1", "an Arrow (Feather) file", "save the table as Parquet"),
    (b"\xd0\xcf\x11\xe0", "an old Excel workbook", "save the sheet as CSV"),
    (b"\x93NUMPY", "a single NPY array", "save the named arrays together as NPZ"),
    (b"%PDF", "a PDF document", "upload the measured data"),
    (b"<", "an XML or HTML document", "upload the measured data as a table"),
    (b"{", "a JSON document", "save the table as CSV or Parquet"),
)


def recognise(path: Path, media_type: str | None = None) -> Form:
    """Decide the format by content and check the claims against it.

    Parameters
    ----------
    path
        The file; its suffix is a claim if it is one that logs use.
    media_type
        The declared content type, with or without parameters; None or `application/octet-stream` claims
        nothing.

    Raises
    ------
    LogError
        If the file is absent or empty, is of no format that holds a log, or contradicts what was declared.
    """
    if not path.is_file():
        raise LogError(
            f"{path.name} cannot be read",
            evidence={"reason": "it is no file" if path.exists() else "it is not there"},
            remedy="name the file of a log; a pipe is not read, so write it to a file first",
        )
    if path.stat().st_size == 0:
        raise LogError(
            "the log is empty", evidence={"bytes": 0}, remedy="upload a file with at least 1 s of motion"
        )
    with path.open("rb") as stream:
        head = stream.read(4096)
    form = _form_of(head)
    _check_media_type(form, media_type)
    _check_suffix(form, path.suffix.lower())
    return form


def _form_of(head: bytes) -> Form:
    for magic, form in _BEGINNINGS:
        if head.startswith(magic):
            return _zip_form(head) if form is NPZ else form
    if head[512:520] == HDF5_SIGNATURE:  # behind a block that is the user's own
        return MATLAB7
    if head[124:128] in (b"\x00\x01IM", b"\x01\x00MI"):
        return MATLAB5
    if head.startswith(UTF_32_MARKS):
        raise _not_a_log("UTF-32 text", "save it as UTF-8")
    if head.startswith(BYTE_ORDER_MARKS):
        head = head.decode(UTF_16, "replace").encode()
    _refuse_foreign(head)
    return DELIMITED


def _refuse_foreign(head: bytes) -> None:
    for magic, what, remedy in _FOREIGN:
        if head.lstrip(b"\xef\xbb\xbf \r\n\t").startswith(magic):
            raise _not_a_log(what, remedy)
    if order := _unmarked_order(head):
        raise _not_a_log(
            f"UTF-16 text ({order} byte first) without a byte order mark",
            "save it as UTF-8, or with the mark",
        )
    if b"\x00" in head:
        raise _not_a_log("binary data with NUL bytes", "upload CSV, Parquet, NPZ or MAT")


def _unmarked_order(head: bytes) -> str:
    """Tell which byte of UTF-16 comes first, where every second byte is NUL as in Latin text."""
    first, second = head[::2], head[1::2]
    if not first.count(0) and 2 * second.count(0) > len(second):
        return "lower"
    return "upper" if not second.count(0) and 2 * first.count(0) > len(first) else ""


def _zip_form(head: bytes) -> Form:
    if b"[Content_Types].xml" in head or b"xl/" in head:
        raise _not_a_log("an Excel workbook", "save the sheet as CSV")
    return NPZ


def _not_a_log(what: str, remedy: str) -> LogError:
    return LogError(
        f"the file is not a log in a known format but {what}",
        evidence={"found": what, "known": [form.name for form in FORMS]},
        remedy=remedy,
    )


def _check_media_type(form: Form, media_type: str | None) -> None:
    declared = (media_type or "").split(";")[0].strip().lower()
    if declared in NO_CLAIM or declared in form.media_types:
        return
    known = sorted({name for each in FORMS for name in each.media_types})
    if declared not in known:
        raise LogError(
            f"a log does not come as {declared}",
            evidence={"declared": declared, "found": form.name, "known": known},
            remedy=f"declare this file as {form.media_types[0]}",
        )
    raise _contradiction(form, declared)


def _check_suffix(form: Form, suffix: str) -> None:
    known = {name for each in FORMS for name in each.suffixes}
    if suffix in known and suffix not in form.suffixes:
        raise _contradiction(form, suffix)


def _contradiction(form: Form, declared: str) -> LogError:
    return LogError(
        f"the file is declared as {declared} but its bytes are {form.name}",
        evidence={"declared": declared, "found": form.name},
        remedy=f"declare it as {form.media_types[0]}, or upload the file that was meant",
    )
