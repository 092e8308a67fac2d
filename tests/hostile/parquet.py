"""Hostile Parquet: footers that promise more than there is, and types that hold no numbers."""

import io
import json
import pickle  # noqa: TID251  (to show that it is refused)
import struct

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from tests.hostile.npz import Trap
from tests.hostile.specimen import ROWS, hostile, motion

FORM = "Parquet"


def written(table: pa.Table, **options) -> bytes:
    stream = io.BytesIO()
    pq.write_table(table, stream, **options)
    return stream.getvalue()


def with_column(values: pa.Array, name: str = "q_1") -> bytes:
    return written(pa.table(motion() | {name: values}))


def constant(rows: int, groups: int, names: tuple[str, ...]) -> bytes:
    """Write rows that take hardly any room."""
    stream = io.BytesIO()
    schema = pa.schema([pa.field(name, pa.float64(), nullable=False) for name in names])
    block = pa.table(dict.fromkeys(names, np.zeros(rows // groups)), schema=schema)
    with pq.ParquetWriter(stream, block.schema, compression="zstd") as writer:
        for _ in range(groups):
            writer.write_table(block, row_group_size=rows)
    return stream.getvalue()


@hostile(FORM)
def three_hundred_million_rows(_place):
    return constant(300_000_000, 100, ("time",))


@hostile(FORM)
def fifty_million_rows_in_a_few_bytes(_place):
    return constant(49_000_000, 7, ("time", "q_1", "tau_1"))


@hostile(FORM)
def two_columns_of_one_name(_place):
    columns = list(motion().values())
    return written(pa.Table.from_arrays(columns, names=["time", "q_1", "q_1", "tau_1", "tau_2"]))


@hostile(FORM)
def twenty_thousand_columns(_place):
    return written(pa.table({f"c{number}": [1.0] for number in range(20_000)}))


@hostile(FORM)
def text_for_numbers(_place):
    return with_column(pa.array(["1.0"] * ROWS))


@hostile(FORM)
def lists_for_numbers(_place):
    return with_column(pa.array([[1.0] * 3] * ROWS))


@hostile(FORM)
def lists_in_lists_a_hundred_deep(_place):
    kind = pa.float64()
    for _ in range(100):
        kind = pa.list_(kind)
    return with_column(pa.nulls(ROWS, kind))


@hostile(FORM)
def nulls_for_numbers(_place):
    return with_column(pa.nulls(ROWS, pa.float64()))


@hostile(FORM)
def not_a_number(_place):
    return with_column(pa.array(np.full(ROWS, np.nan)))


@hostile(FORM)
def numbers_beyond_any_size(_place):
    return with_column(pa.array(np.full(ROWS, 1e300)))


@hostile(FORM)
def a_type_that_brings_a_pickle(place):
    """As in CVE-2023-47248: reading the schema ran code in releases of pyarrow before 14.0.1."""
    serialized = pickle.dumps(Trap(place.folder / "written"))
    field = pa.field(
        "q_1",
        pa.float64(),
        metadata={
            b"ARROW:extension:name": b"arrow.py_extension_type",
            b"ARROW:extension:metadata": serialized,
        },
    )
    columns = motion()
    del columns["tau_1"]
    fields = [field if name == "q_1" else pa.field(name, pa.float64()) for name in columns]
    return written(pa.table(list(columns.values()), schema=pa.schema(fields)))


@hostile(FORM)
def a_gigabyte_of_equal_text_in_a_needed_column(_place):
    letters = pa.array(["x" * 1_000_000])
    return with_column(pa.DictionaryArray.from_arrays(np.zeros(ROWS, dtype=np.int32), letters))


@hostile(FORM)
def a_footer_that_is_longer_than_the_file(_place):
    return written(pa.table(motion()))[:-8] + struct.pack("<I", 2**31 - 1) + b"PAR1"


@hostile(FORM)
def a_footer_of_negative_length(_place):
    return written(pa.table(motion()))[:-8] + struct.pack("<I", 2**32 - 1) + b"PAR1"


@hostile(FORM)
def a_footer_of_noise(_place):
    noise = np.random.default_rng(1).bytes(4000)
    return b"PAR1" + noise + struct.pack("<I", len(noise)) + b"PAR1"


@hostile(FORM)
def a_footer_that_nests_without_end(_place):
    nested = b"\x1c" * 100_000  # thrift's compact protocol: a structure in a structure in a structure
    return b"PAR1" + nested + struct.pack("<I", len(nested)) + b"PAR1"


@hostile(FORM)
def a_footer_with_a_list_of_billions(_place):
    head = b"\x15\x04\x19\xfc" + b"\xff\xff\xff\xff\x07" + bytes(64)
    return b"PAR1" + head + struct.pack("<I", len(head)) + b"PAR1"


@hostile(FORM)
def an_encrypted_footer(_place):
    whole = written(pa.table(motion()))
    return b"PAR1" + whole[4:-4] + b"PARE"


@hostile(FORM)
def a_file_cut_short(_place):
    return written(pa.table(motion()))[:4000]


@hostile(FORM)
def pages_full_of_noise(_place):
    whole = bytearray(written(pa.table(motion()), use_dictionary=False))
    whole[4:9000] = np.random.default_rng(2).bytes(8996)
    return bytes(whole)


@hostile(FORM)
def page_headers_that_promise_gigabytes(_place):
    """The first field of a page header is its type, the second its unpacked size: make that 2 GB."""
    table = pa.table(motion())
    whole = bytearray(written(table, use_dictionary=False, compression="snappy"))
    at = 4
    assert whole[at : at + 3] == b"\x15\x00\x15", "the layout of the page header has changed"
    varint_end = next(place for place in range(at + 3, at + 10) if whole[place] < 128) + 1
    width = varint_end - (at + 3)
    whole[at + 3 : varint_end] = b"\xff" * (width - 1) + b"\x7f"
    return bytes(whole)


@hostile(FORM)
def a_schema_that_contradicts_the_footer(_place):
    schema = pa.schema([pa.field("time", pa.float64())], metadata={b"pandas": json.dumps({"a": 1}).encode()})
    return written(pa.table({"time": motion()["time"]}).cast(schema))
