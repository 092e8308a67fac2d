"""Hostile text: lines, names and numbers without end, other alphabets, and what is no table at all."""

import gzip
import io
import sqlite3
import tarfile
import zipfile
from pathlib import Path

import numpy as np

from tests.hostile.specimen import ROWS, hostile, motion

FORM = "text"


def table(
    names: list[str] | None = None, *, first: str | None = None, delimiter: str = ",", most: bool = False
) -> bytes:
    """Write a sound log, under other names, or with another first row that stands in its middle as well.

    Single rows that lack a value are left out, so that such a row stands in most places where it is to hurt.
    """
    columns = motion()
    rows = [delimiter.join(f"{value:.6f}" for value in row) for row in zip(*columns.values(), strict=True)]
    if first is not None:
        rows[0] = first
        values, middle = first.split(delimiter, 1)[1:], len(rows) // 2  # a row at an end is left out
        for place in range(len(rows) // 5, 4 * len(rows) // 5) if most else (middle,):
            rows[place] = delimiter.join([rows[place].split(delimiter)[0], *values])
    return "\n".join([delimiter.join(names or columns), *rows]).encode()


@hostile(FORM)
def nothing(_place):
    return b""


@hostile(FORM)
def a_nul_byte_in_the_header(_place):
    return table().replace(b"q_1", b"q\x00_1", 1)


@hostile(FORM)
def a_nul_byte_deep_in_the_table(_place):
    return table() * 60 + b"\x00"


@hostile(FORM)
def utf_16_without_its_mark(_place):
    return table().decode().encode("utf-16-le")


@hostile(FORM)
def utf_16_of_half_characters(_place):
    return b"\xff\xfe" + table().decode().encode("utf-16-le") + b"\x00\xdc" * 500_000


@hostile(FORM)
def utf_16_of_a_line_without_end(_place):
    return ("time,q_1,tau_1\n" + "1" * 10_000_000).encode("utf-16")


@hostile(FORM)
def utf_32(_place):
    return table().decode().encode("utf-32")


@hostile(FORM)
def latin_1_names(_place):
    return table(["time", "q_1", "q_2", "tau_1", "Prüfung"]).decode().encode("latin-1")


@hostile(FORM)
def half_characters(_place):
    return table().replace(b"q_1", b"q_\xed\xa0\x80", 1)


@hostile(FORM)
def a_first_line_without_end(_place):
    return b"time," * 4_000_000


@hostile(FORM)
def a_second_line_without_end(_place):
    return b"time,q_1,tau_1\n" + b"1" * 20_000_000


@hostile(FORM)
def a_quotation_that_never_ends(_place):
    return table(first='0,"1' + "\n" * 100, most=True)


@hostile(FORM)
def a_quoted_name_without_end(_place):
    return b'time,"' + b"x" * 300_000 + b'",tau_1\n1,2,3\n'


@hostile(FORM)
def a_name_of_a_hundred_kilobytes(_place):
    return table(["time", "q_1", "q_2", "tau_1", "x" * 100_000])


@hostile(FORM)
def five_hundred_and_thirteen_columns(_place):
    names = ",".join(f"c{number}" for number in range(513))
    return (names + "\n" + ",".join(["1"] * 513)).encode()


@hostile(FORM)
def a_hundred_thousand_columns(_place):
    return b",".join(b"q_%d" % number for number in range(100_000)) + b"\n"


@hostile(FORM)
def nothing_but_delimiters(_place):
    return b"," * 500 + b"\n" + (b"," * 500 + b"\n") * 2000


@hostile(FORM)
def two_columns_of_one_name(_place):
    return table(["time", "q_1", "q_1", "tau_1", "tau_2"])


@hostile(FORM)
def not_a_number(_place):
    return table(first="0,nan,1,1,1", most=True)


@hostile(FORM)
def infinity(_place):
    return table(first="0,-inf,1,1,1", most=True)


@hostile(FORM)
def a_number_beyond_floats(_place):
    return table(first="0,1e999,1,1,1", most=True)


@hostile(FORM)
def numbers_of_thousands_of_digits(_place):
    return table(first="0," + "9" * 2_000 + ",1,1,1", most=True)


@hostile(FORM)
def numbers_of_other_alphabets(_place):
    return table(first="0,١٢٣,1,1,1")


@hostile(FORM)
def a_formula(_place):
    return table(first='0,"=HYPERLINK(""http://example.org"")",1,1,1')


@hostile(FORM)
def three_million_comments(_place):
    return b"time,q_1,tau_1\n0,1,2\n" + b"#\n" * 3_000_000


@hostile(FORM)
def a_million_empty_lines(_place):
    return b"\n" * 1_100_000 + table()


@hostile(FORM)
def two_million_rows_of_one_byte(_place):
    return b"time,q_1,tau_1\n" + b"1\n" * 2_000_000


@hostile(FORM)
def two_million_rows_that_are_ragged(_place):
    return b"time,q_1,tau_1\n" + b"1,2,3\n1,2\n" * 1_000_000


@hostile(FORM)
def carriage_returns_only_and_no_rows(_place):
    return b"time,q_1,tau_1\r" * 3


@hostile(FORM)
def a_byte_order_mark_and_nothing(_place):
    return b"\xef\xbb\xbf"


OTHER = "other"


@hostile(OTHER)
def a_gzip_bomb(_place):
    return gzip.compress(bytes(100_000_000))


@hostile(OTHER)
def a_tape_archive_with_a_link(_place):
    stream = io.BytesIO()
    with tarfile.open(fileobj=stream, mode="w") as archive:
        link = tarfile.TarInfo("log.csv")
        link.type, link.linkname = tarfile.SYMTYPE, "/etc/passwd"
        archive.addfile(link)
    return stream.getvalue()


@hostile(OTHER)
def entities_that_multiply(_place):
    levels = "".join(f'<!ENTITY a{n} "{f"&a{n - 1};" * 10}">' for n in range(1, 10))
    return f'<?xml version="1.0"?><!DOCTYPE r [<!ENTITY a0 "ha">{levels}]><r>&a9;</r>'.encode()


@hostile(OTHER)
def an_entity_of_a_system_file(_place):
    return b'<?xml version="1.0"?><!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]><r>&x;</r>'


@hostile(OTHER)
def json_nested_without_end(_place):
    return b'{"a":' * 100_000


@hostile(OTHER)
def an_office_workbook(_place):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr("[Content_Types].xml", "<x/>")
        archive.writestr("xl/workbook.xml", "<x/>")
    return stream.getvalue()


@hostile(OTHER)
def a_database(place):
    path = place.folder / "made.db"
    path.unlink(missing_ok=True)
    connection = sqlite3.connect(path)
    connection.execute("create table log (time real)")
    connection.commit()
    connection.close()
    return Path(path).read_bytes()


@hostile(OTHER)
def a_program(_place):
    return b"\x7fELF\x02\x01\x01" + bytes(9) + np.random.default_rng(1).bytes(5000)


@hostile(OTHER)
def noise(_place):
    return np.random.default_rng(2).bytes(ROWS * 100)


@hostile(OTHER)
def an_archive_behind_a_table(_place):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr("q.npy", b"")
    return table(first="0,a,b,c,d") + stream.getvalue()
