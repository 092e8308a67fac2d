import numpy as np
import pytest
from scipy.io import savemat

from tests.core.log.writers import WRITERS, swing, write_csv, write_mat7, write_npz, write_parquet
from veritorque.core.errors import LogError
from veritorque.core.log.model import whole_rows
from veritorque.core.log.reader import read_log

COLUMNS = swing()
FORMS = pytest.mark.parametrize("form", WRITERS)


@FORMS
def test_every_format_gives_back_the_samples_that_were_written(form, tmp_path):
    name, write = WRITERS[form]
    log = read_log(write(tmp_path / name, COLUMNS))
    rows = whole_rows(log)
    assert log.joints == 3
    assert log.channels == ("position", "torque")
    np.testing.assert_array_equal(rows.time, COLUMNS["time"])
    np.testing.assert_array_equal(rows.position, np.column_stack([COLUMNS[f"q_{j}"] for j in (1, 2, 3)]))
    np.testing.assert_array_equal(rows.torque, np.column_stack([COLUMNS[f"tau_{j}"] for j in (1, 2, 3)]))
    assert rows.position.flags.c_contiguous


@FORMS
def test_a_healthy_log_has_no_defect(form, tmp_path):
    name, write = WRITERS[form]
    log = read_log(write(tmp_path / name, COLUMNS))
    assert log.defects == ()
    assert log.segments == ((0, 3000),)
    assert log.rate_hz == pytest.approx(250.0, rel=1e-9)


@FORMS
def test_a_file_cut_short_or_overwritten_is_a_log_error_or_still_a_log(form, tmp_path):
    """Only our own error may come out of damage. Text loses the damaged rows, and the log says so."""
    name, write = WRITERS[form]
    whole = write(tmp_path / name, COLUMNS).read_bytes()
    random = np.random.default_rng(1)
    is_text, refusals = form in ("CSV", "TSV"), []
    for trial in range(12):
        damaged = bytearray(whole[: int(random.integers(20, len(whole)))] if trial % 2 else whole)
        if trial % 2 == 0:
            at = int(random.integers(0, len(damaged) - 64))
            damaged[at : at + 64] = random.bytes(64)
        path = tmp_path / f"damaged{trial}{(tmp_path / name).suffix}"
        path.write_bytes(bytes(damaged))
        try:
            log = read_log(path)
            assert log.defects or not is_text or trial % 2
        except LogError as error:
            refusals.append(error)
    assert is_text or len(refusals) >= 6
    assert all(error.remedy for error in refusals)
    assert not any("TypeCheckError" in str(error.evidence) for error in refusals)  # a fault of ours


@FORMS
def test_bytes_that_contradict_the_declared_type_name_both(form, tmp_path):
    name, write = WRITERS[form]
    path = write(tmp_path / name, COLUMNS)
    declared = "application/x-npz" if form != "NPZ" else "text/csv"
    with pytest.raises(LogError) as caught:
        read_log(path, media_type=declared)
    assert caught.value.evidence["declared"] == declared
    assert caught.value.evidence["found"] == form.replace("TSV", "CSV")


def test_a_suffix_that_contradicts_the_bytes_is_refused(tmp_path):
    path = write_csv(tmp_path / "log.csv", COLUMNS).rename(tmp_path / "log.parquet")
    with pytest.raises(LogError, match=r"declared as \.parquet but its bytes are CSV"):
        read_log(path)


def test_a_media_type_that_logs_do_not_have_is_refused_with_the_list(tmp_path):
    with pytest.raises(LogError) as caught:
        read_log(write_csv(tmp_path / "log", COLUMNS), media_type="application/json; charset=utf-8")
    assert "text/csv" in caught.value.evidence["known"]


def test_text_may_have_comments_semicolons_and_decimal_commas(tmp_path):
    path = write_csv(tmp_path / "log.csv", COLUMNS, ";", before="# made by a robot\n\n")
    text = path.read_text(encoding="utf-8").replace(".", ",").split("\n")
    path.write_text("\n".join([*text[:50], "# paused here", *text[50:]]), encoding="utf-8")
    np.testing.assert_array_equal(whole_rows(read_log(path)).position[:, 0], COLUMNS["q_1"])


def test_whole_zeros_in_the_first_rows_hide_no_decimal_commas(tmp_path):
    path = write_csv(tmp_path / "log.csv", COLUMNS, ";")
    header, *rows = path.read_text(encoding="utf-8").replace(".", ",").split("\n")
    zeros = [";".join("0" for _ in COLUMNS)] * 5
    path.write_text("\n".join([header, *zeros, *rows]), encoding="utf-8")
    np.testing.assert_array_equal(whole_rows(read_log(path)).position[-100:, 0], COLUMNS["q_1"][-100:])


@pytest.mark.parametrize("kilobytes", [1047, 1048, 1049, 3000])
def test_a_header_may_stand_below_megabytes_of_comments(tmp_path, kilobytes):
    comments = ("# " + "c" * 997 + "\n") * kilobytes
    path = write_csv(tmp_path / "log.csv", COLUMNS, before=comments + "# " + "c" * 500 + "\n")
    np.testing.assert_array_equal(whole_rows(read_log(path)).position[:, 0], COLUMNS["q_1"])
    np.savetxt(path, np.column_stack(list(COLUMNS.values())), delimiter=",", header=",".join(COLUMNS))
    path.write_text(comments + path.read_text(encoding="utf-8"), encoding="utf-8")
    assert read_log(path).joints == 3


def test_a_header_written_as_a_comment_by_savetxt_is_a_header(tmp_path):
    path = tmp_path / "log.csv"
    np.savetxt(path, np.column_stack(list(COLUMNS.values())), delimiter=",", header=",".join(COLUMNS))
    assert read_log(path).joints == 3


def test_columns_that_are_not_named_are_listed_and_need_not_be_numbers(tmp_path):
    path = write_csv(tmp_path / "log.csv", COLUMNS)
    lines = path.read_text(encoding="utf-8").splitlines()
    labelled = [f"{line},{'label' if row == 0 else 'moving'}" for row, line in enumerate(lines)]
    path.write_text("\n".join(labelled) + "\n", encoding="utf-8")
    assert read_log(path).ignored_columns == ("label",)


def test_a_structure_of_arrays_in_a_mat_file_flattens_to_dotted_names(tmp_path):
    plain = {
        "time": COLUMNS["time"],
        "arm": {"pos": COLUMNS["q_1"], "torque": COLUMNS["tau_1"]},
        "note": "hello",
    }
    savemat(tmp_path / "log.mat", plain)
    mapping = {
        "position": {"columns": ["arm.pos"], "unit": "rad"},
        "torque": {"columns": ["arm.torque"], "unit": "N m"},
    }
    log = read_log(tmp_path / "log.mat", mapping=mapping)
    np.testing.assert_array_equal(whole_rows(log).position[:, 0], COLUMNS["q_1"])
    assert log.ignored_columns == ("note",)


def test_a_matrix_lies_along_its_longer_side_however_it_was_stored(tmp_path):
    tall = {"time": COLUMNS["time"], "q": np.array([COLUMNS["q_1"], COLUMNS["q_2"]]).T}
    tall["tau"] = 10 * tall["q"]
    np.savez(tmp_path / "tall.npz", **tall)
    np.savez(tmp_path / "wide.npz", **{name: values.T for name, values in tall.items()})
    one, other = (whole_rows(read_log(tmp_path / name)) for name in ("tall.npz", "wide.npz"))
    np.testing.assert_array_equal(one.position, other.position)


def test_a_pickled_object_in_an_archive_is_never_loaded(tmp_path):
    np.savez(tmp_path / "log.npz", time=COLUMNS["time"], q=np.array([print, {}], dtype=object))
    with pytest.raises(LogError, match="pickled Python object"):
        read_log(tmp_path / "log.npz")


@pytest.mark.parametrize("form", ["CSV", "NPZ", "MATLAB v5", "MATLAB v7.3"])
def test_a_file_that_needs_more_memory_than_allowed_is_refused_unread(form, tmp_path, monkeypatch):
    monkeypatch.setattr("veritorque.core.log.formats.table.MAX_VALUES_IN_MEMORY", 20_000)
    name, write = WRITERS[form]
    with pytest.raises(LogError, match="too large for a format that must be held in memory") as caught:
        read_log(write(tmp_path / name, COLUMNS))
    assert caught.value.evidence["values"] >= 21_000
    assert "Parquet" in caught.value.remedy


@pytest.mark.parametrize("kind", ["external_link", "soft_link", "external_storage", "virtual"])
def test_an_hdf5_file_that_points_outside_itself_is_refused(kind, tmp_path):
    import h5py

    path = write_mat7(tmp_path / "log.mat", COLUMNS)
    (tmp_path / "secret.bin").write_bytes(bytes(8 * 3000))
    with h5py.File(path, "r+") as file:
        if kind == "external_link":
            file["stolen"] = h5py.ExternalLink("/etc/passwd", "/")
        elif kind == "soft_link":
            file["stolen"] = h5py.SoftLink("/q")
        elif kind == "external_storage":
            outside = [(str(tmp_path / "secret.bin"), 0, 8 * 3000)]
            file.create_dataset("stolen", shape=(3000,), dtype="f8", external=outside)
        else:
            layout = h5py.VirtualLayout(shape=(3000,), dtype="f8")
            layout[:] = h5py.VirtualSource(str(tmp_path / "other.h5"), "x", shape=(3000,))
            file.create_virtual_dataset("stolen", layout)
    with pytest.raises(LogError, match="refers to data outside itself"):
        read_log(path)


def test_groups_that_hold_each_other_are_entered_once(tmp_path):
    import h5py

    path = write_mat7(tmp_path / "log.mat", COLUMNS)
    with h5py.File(path, "r+") as file:
        file["arm/hand/x"] = np.zeros(3000)
        file["arm/hand/arm"] = file["arm"]
    assert read_log(path).ignored_columns == ("arm.hand.x",)


def test_a_hundred_thousand_columns_are_refused_quickly(tmp_path):
    names = ",".join(f"c{index}" for index in range(100_000))
    (tmp_path / "log.csv").write_text(names + "\n" + names, encoding="utf-8")
    with pytest.raises(LogError) as caught:
        read_log(tmp_path / "log.csv")
    assert caught.value.evidence == {"columns": 100_000, "at_most": 512}


def test_a_header_without_end_is_refused(tmp_path):
    (tmp_path / "log.csv").write_text("time," * 400_000, encoding="utf-8")
    with pytest.raises(LogError, match="first line is longer than 1 MB"):
        read_log(tmp_path / "log.csv")


def test_text_from_windows_with_a_byte_order_mark_is_text(tmp_path):
    path = write_csv(tmp_path / "log.csv", COLUMNS)
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes().replace(b"\n", b"\r\n"))
    np.testing.assert_array_equal(whole_rows(read_log(path)).torque[:, 2], COLUMNS["tau_3"])


@pytest.mark.parametrize("form", ["CSV", "Parquet", "NPZ", "MATLAB v7.3"])
def test_more_columns_than_a_log_can_have_are_refused(form, tmp_path):
    name, write = WRITERS[form]
    many = {"time": np.arange(600.0), "q": np.zeros((600, 520)), "tau": np.zeros((600, 520))}
    path = tmp_path / name
    if form in ("CSV", "Parquet"):
        write(path, {"time": many["time"], **{f"q_{j + 1}": many["q"][:, j] for j in range(520)}})
    elif form == "NPZ":
        np.savez(path, **many)
    else:
        import h5py

        with h5py.File(path, "w") as file:
            for key, values in many.items():
                file[key] = values
    with pytest.raises(LogError, match="more columns than a log can have"):
        read_log(path)


@pytest.mark.parametrize(
    ("head", "what"),
    [
        (b"\x1f\x8b\x08", "gzip"),
        (b"\x89MCAP0\r\n", "MCAP"),
        (b"PK\x03\x04....[Content_Types].xml", "Excel"),
        (b'{"time": [0, 1]}', "JSON"),
        (b"time,q_1\n\x00\x01\x02", "NUL"),
    ],
)
def test_a_file_of_another_kind_is_called_by_its_name(head, what, tmp_path):
    (tmp_path / "upload").write_bytes(head + b" " * 200)
    with pytest.raises(LogError, match=what):
        read_log(tmp_path / "upload")


def test_the_hash_is_that_of_the_files_bytes(tmp_path):
    import hashlib

    path = write_npz(tmp_path / "log.npz", COLUMNS)
    assert read_log(path).sha256 == hashlib.sha256(path.read_bytes()).hexdigest()
    assert read_log(path, sha256="known").sha256 == "known"


def test_integer_and_single_precision_columns_are_numbers_too(tmp_path):
    columns = dict(
        COLUMNS, tau_1=COLUMNS["tau_1"].astype(np.float32), q_2=(COLUMNS["q_2"] * 1000).astype(np.int32)
    )
    rows = whole_rows(read_log(write_parquet(tmp_path / "log.parquet", columns)))
    np.testing.assert_array_equal(rows.torque[:, 0], columns["tau_1"].astype(float))
    np.testing.assert_array_equal(rows.position[:, 1], columns["q_2"].astype(float))
