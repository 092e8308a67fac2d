"""Hostile ROS recordings: chunks that unpack without end, and lengths that lie."""

import bz2
import io
import struct
import tempfile
from pathlib import Path

import pyarrow as pa

from tests.core.log.recordings import write_bag, write_mcap
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
