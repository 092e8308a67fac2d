"""Hostile ROS recordings: chunks that unpack without end, lengths that lie, and databases that compute."""

import bz2
import io
import sqlite3
import struct
import tempfile
from contextlib import closing
from pathlib import Path

import numpy as np
import pyarrow as pa

from tests.core.log.recordings import write_bag, write_mcap, write_sqlite
from tests.hostile.specimen import hostile, motion

FORM = "recording"
MAGIC = b"\x89MCAP0\r\n"
END = b"\x02" + struct.pack("<QQQI", 20, 0, 0, 0) + MAGIC
BAG_MAGIC = b"#ROSBAG V2.0\n"


def sound(write) -> bytes:
    columns = motion()
    columns |= {f"qd_{joint}": columns[f"q_{joint}"] for joint in (1, 2)}
    short = {name: values[:250] for name, values in columns.items()}
    with tempfile.TemporaryDirectory() as folder:
        return write(Path(folder), short, {"joint1": 1, "joint2": 2}).read_bytes()


def text(content: bytes) -> bytes:
    return struct.pack("<I", len(content)) + content


def record(kind: int, content: bytes) -> bytes:
    return bytes([kind]) + struct.pack("<Q", len(content)) + content


def mcap(*records: bytes) -> bytes:
    """Write records without an index, so that a reader has to walk them."""
    return MAGIC + record(1, text(b"ros2") + text(b"")) + b"".join(records) + record(0x0F, bytes(4)) + END


def chunk(size: int, packing: bytes, content: bytes) -> bytes:
    head = struct.pack("<QQQI", 0, 1, size, 0) + text(packing)
    return record(6, head + struct.pack("<Q", len(content)) + content)


def fields(**named: bytes) -> bytes:
    """Write a header of a bag's record."""
    pairs = (name.encode() + b"=" + value for name, value in named.items())
    return text(b"".join(text(pair) for pair in pairs))


def bag(*records: bytes, index: int = 4117, chunks: int = 1) -> bytes:
    head = fields(
        op=b"\x03",
        index_pos=struct.pack("<Q", index),
        conn_count=bytes(4),
        chunk_count=struct.pack("<I", chunks),
    )
    return (BAG_MAGIC + head + text(b" " * 4000))[:4117].ljust(4117) + b"".join(records)


def database(*statements: str, page: int = 4096) -> bytes:
    """Write a bag in SQLite by statements; topics are there, and the first one is of joint states."""
    with tempfile.TemporaryDirectory() as folder:
        with closing(sqlite3.connect(Path(folder) / "made.db3")) as made, made:
            made.execute(f"PRAGMA page_size = {page}")
            made.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name, type, serialization_format)")
            made.execute("INSERT INTO topics VALUES (1, '/j', 'sensor_msgs/msg/JointState', 'cdr')")
            for statement in statements:
                made.execute(statement)
        return (Path(folder) / "made.db3").read_bytes()


MESSAGES = "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, timestamp, data)"
NUMBERS = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n LIMIT {}) "


@hostile(FORM)
def a_view_in_the_place_of_messages_that_never_ends(_place):
    return database(
        "CREATE VIEW messages AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i FROM n) "
        "SELECT i AS id, 1 AS topic_id, i AS timestamp, zeroblob(900000) AS data FROM n"
    )


@hostile(FORM)
def a_view_that_reads_another_file(place):
    return database(
        MESSAGES,
        f"CREATE VIEW more AS SELECT readfile('{place.secret}') AS data, load_extension('{place.secret}')",
    )


@hostile(FORM)
def a_virtual_table_in_the_place_of_messages(_place):
    made = database(MESSAGES)
    return made.replace(
        MESSAGES.encode(), b"CREATE VIRTUAL TABLE messages USING fts4(a)".ljust(len(MESSAGES)), 1
    )


@hostile(FORM)
def contents_that_the_schema_computes(_place):
    return database(
        f"{MESSAGES[:-5]}data GENERATED ALWAYS AS (hex(zeroblob(450000))))",
        f"INSERT INTO messages (topic_id, timestamp) {NUMBERS.format(100_000)} SELECT 1, i FROM n",
    )


def circling(topic: int) -> bytes:
    """Write a bag in which every page of the upper levels gives the page below it in all its places."""
    of_no_joint = f"x'00010000{8 * '00'}01000000{20 * '00'}'"
    rows = f"INSERT INTO messages {NUMBERS.format(20_000)} SELECT i, {topic}, i, {of_no_joint} FROM n"
    page = 512
    made = bytearray(database(MESSAGES, rows, page=page))
    pages = range(page, len(made), page)
    inner = [at for at in pages if made[at] == 5][:12]
    leaf = next(at for at in reversed(pages) if made[at] == 13)
    for at, below in zip(inner, [*inner[1:], leaf], strict=True):
        number = below // page + 1
        struct.pack_into(">I", made, at + 8, number)
        for cell in struct.unpack_from(f">{made[at + 4]}H", made, at + 12):
            struct.pack_into(">I", made, at + cell, number)
    return bytes(made)


@hostile(FORM)
def a_tree_of_pages_that_repeats_its_messages_for_ever(_place):
    return circling(topic=1)


@hostile(FORM)
def a_tree_of_pages_that_never_comes_to_a_message(_place):
    return circling(topic=2)


@hostile(FORM)
def a_topic_whose_name_is_megabytes(_place):
    topics = "INSERT INTO topics SELECT NULL, printf('%.*c', 900000, 'a') || id, type, 'cdr' FROM topics"
    return database(MESSAGES, *[topics] * 6)


@hostile(FORM)
def a_hundred_thousand_topics_in_a_database(_place):
    return database(
        MESSAGES,
        f"INSERT INTO topics {NUMBERS.format(100_000)} SELECT i + 1, '/t' || i, "
        "'sensor_msgs/msg/JointState', 'cdr' FROM n",
    )


@hostile(FORM)
def values_of_other_kinds_in_every_column(_place):
    return database(MESSAGES, "INSERT INTO messages VALUES (1, 1, 'noon', 'text'), (2, 1, NULL, 7)")


@hostile(FORM)
def a_message_that_claims_four_billion_names(_place):
    content = "0001000000000000000000000100000000000000ffffffff"
    return database(MESSAGES, f"INSERT INTO messages VALUES (1, 1, 5, x'{content}')")


@hostile(FORM)
def a_database_of_tables_that_are_no_bag(_place):
    return database("CREATE TABLE log (time REAL)")


@hostile(FORM)
def a_database_cut_short(_place):
    whole = sound(write_sqlite)
    return whole[: len(whole) // 2]


@hostile(FORM)
def a_database_that_claims_pages_without_end(_place):
    whole = bytearray(sound(write_sqlite))
    struct.pack_into(">I", whole, 28, 2**31)
    struct.pack_into(">I", whole, 32, 2**31)
    return bytes(whole[:100]) + bytes(200_000)


@hostile(FORM)
def a_database_header_and_noise(_place):
    return b"SQLite format 3\x00" + np.random.default_rng(5).bytes(60_000)


@hostile(FORM)
def a_chunk_that_unpacks_to_half_a_gigabyte(_place):
    return mcap(chunk(1 << 29, b"zstd", pa.Codec("zstd").compress(bytes(1 << 29), asbytes=True)))


@hostile(FORM)
def a_chunk_that_claims_to_be_small(_place):
    return mcap(chunk(64, b"zstd", pa.Codec("zstd").compress(bytes(1 << 29), asbytes=True)))


@hostile(FORM)
def a_chunk_in_a_packing_that_nobody_knows(_place):
    return mcap(chunk(64, b"../../bin/sh", bytes(64)))


@hostile(FORM)
def a_record_of_exabytes(_place):
    return mcap(b"\x05" + struct.pack("<Q", 2**62) + bytes(100))


@hostile(FORM)
def three_hundred_thousand_empty_records(_place):
    return mcap(record(0x80, b"") * 300_000)


@hostile(FORM)
def sixty_thousand_topics(_place):
    schema = record(
        3, struct.pack("<H", 1) + text(b"sensor_msgs/msg/JointState") + text(b"ros2msg") + text(b"")
    )
    channels = (
        record(4, struct.pack("<HH", number, 1) + text(b"/t%d" % number) + text(b"cdr") + text(b""))
        for number in range(60_000)
    )
    return mcap(schema, *channels)


@hostile(FORM)
def names_of_joints_of_four_gigabytes(_place):
    return sound(write_mcap).replace(text(b"joint1\x00"), b"\xff\xff\xff\xff" + b"joint1\x00")


@hostile(FORM)
def a_recording_without_its_end(_place):
    whole = sound(write_mcap)
    return whole[: len(whole) // 2]


@hostile(FORM)
def a_bag_whose_index_lies_behind_its_end(_place):
    return bag(index=2**40)


@hostile(FORM)
def a_bag_with_billions_of_chunks(_place):
    return bag(chunks=2**32 - 1)


@hostile(FORM)
def a_bag_whose_chunk_unpacks_without_end(_place):
    """The index of a sound bag leads to a chunk that holds a quarter of a gigabyte."""
    whole = sound(write_bag)
    at = whole.index(b"compression=none")
    packed = bz2.compress(bytes(1 << 28))
    stream = io.BytesIO(whole)
    stream.seek(at)
    stream.write(b"compression=bz2 ")
    spoilt = stream.getvalue().replace(b"compression=bz2 ", b"compression=bz2\x00", 1)
    begin = spoilt.index(b"size=", at) + 9
    return spoilt[:begin] + text(packed) + spoilt[begin + 4 + len(packed) :]


@hostile(FORM)
def a_bag_header_of_noise(_place):
    return BAG_MAGIC + struct.pack("<I", 2**31) + bytes(5000)


@hostile(FORM)
def a_bag_cut_short(_place):
    whole = sound(write_bag)
    return whole[: len(whole) // 2]
