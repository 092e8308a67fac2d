"""Bad input is answered with a problem that says what is wrong and what to do, and the service goes on."""

import gzip
import io
import json
import pickle  # noqa: TID251  (to show that it is refused)

import numpy as np
import pytest

from tests.app.conftest import assert_problem
from tests.app.planar_arm import columns, csv_log, description
from veritorque.app.http.body.uploads import LONGEST_TEXT_FILE
from veritorque.app.kinds.registry import KINDS

JSON, CSV, XML = ({"Content-Type": kind} for kind in ("application/json", "text/csv", "application/xml"))


@pytest.fixture(autouse=True)
def the_service_still_answers_afterwards(client):
    yield
    assert client.get("/healthz").json() == {"status": "alive"}
    answer = client.post("/v1/logs", content=csv_log(seconds=2.0), headers=CSV)
    assert answer.status_code == 201


# ------------------------------------------------------------------------------------------------------- logs


def table(*, names=("time", "q_1", "q_2", "tau_1", "tau_2"), change=lambda data: data):
    time, position, torque = columns(seconds=2.0)
    data = change(np.column_stack([time, position, torque]))
    rows = [",".join(f"{value:.6f}" for value in row) for row in data]
    return "\n".join([",".join(names), *rows]).encode()


def put(row, column, value):
    def change(data):
        data[row, column] = value
        return data

    return change


def pickled_npz():
    file = io.BytesIO()
    np.savez(file, time=np.arange(5.0), q_1=np.array([{"a": 1}], dtype=object))
    return file.getvalue()


BAD_LOGS = {
    "an empty file": b"",
    "a header alone": b"time,q_1,tau_1\n",
    "one row": b"time,q_1,tau_1\n0,1,2\n",
    "wrong columns": table(names=("t", "a", "b", "c", "d")),
    "two columns of one name": table(names=("time", "q_1", "q_1", "tau_1", "tau_2")),
    "NaN": table(change=put(slice(7, None), 1, np.nan)),
    "infinity": table(change=put(slice(7, None), 3, np.inf)),
    "joints that never move": table(change=put(slice(None), slice(1, 3), 0.5)),
    "time that starts again and again": table(change=lambda data: data[np.arange(len(data)) % 7 * 50]),
    "one stamp for all": table(change=put(slice(None), 0, 0.1)),
    "torque all zero": table(change=put(slice(None), slice(3, 5), 0.0)),
    "words for numbers": table().replace(b"0.1", b"abc"),
    "100,000 columns": b",".join(b"q_%d" % n for n in range(100_000)) + b"\n",
    "NUL bytes": table() + b"\x00\x00",
    "binary noise": bytes(range(256)) * 50,
    "an archive": gzip.compress(table()),
    "HTML": b"<html><body>not found</body></html>",
    "a ragged table": table() + 20 * b"1,2,3\n" + table().partition(b"\n")[2],
    "not UTF-8": b"time,q_1,tau_1\n\xff\xfe\xff,1,2\n",
}


@pytest.mark.parametrize("content", BAD_LOGS.values(), ids=BAD_LOGS.keys())
@pytest.mark.parametrize("way", ["body", "form"])
def test_a_log_that_cannot_be_used_is_refused(client, content, way):
    if way == "body":
        answer = client.post("/v1/logs", content=content, headers=CSV)
    else:
        answer = client.post("/v1/logs", files={"file": ("log.csv", content, "text/csv")})
    assert assert_problem(answer, 422, "log")["remedy"]


@pytest.mark.parametrize(
    ("media_type", "content"),
    [
        ("application/x-npz", pickled_npz()),
        ("application/x-npz", b"PK\x03\x04 not a zip"),
        ("application/x-npz", table()),
        ("application/vnd.apache.parquet", b"PAR1 cut short"),
        ("application/x-matlab-data", b"MATLAB 7.3 cut short"),
        ("application/x-matlab-data", table()),
    ],
)
def test_a_file_that_is_broken_or_not_what_it_claims_is_refused(client, media_type, content):
    answer = client.post("/v1/logs", content=content, headers={"Content-Type": media_type})
    assert_problem(answer, 422, "log")


def test_a_pickle_is_never_loaded(client):
    class Trap:
        def __reduce__(self):
            return pytest.fail, ("a pickle was loaded",)

    for media_type in ("application/octet-stream", "application/x-npz"):
        answer = client.post("/v1/logs", content=pickle.dumps(Trap()), headers={"Content-Type": media_type})
        assert_problem(answer, 422, "log")


def test_an_unknown_unit_is_refused_with_the_known_ones(client):
    mapping = json.dumps({"torque": {"columns": ["tau_1", "tau_2"], "unit": "furlong"}})
    answer = client.post("/v1/logs", content=table(), headers=CSV, params={"mapping": mapping})
    assert "N m" in json.dumps(assert_problem(answer, 422, "log")["evidence"])


@pytest.mark.parametrize(
    ("mapping", "status", "kind"),
    [
        ('{"rate_hz": NaN}', 400, "not-json"),
        ('{"rate_hz": 1e999}', 400, "not-json"),
        ("{", 400, "not-json"),
        ("[1]", 422, "request"),
        ('{"mood": {}}', 422, "log"),
        ('{"time": {"column": "\\ud800"}}', 400, "not-json"),
        ('{"time": {"column": 7}}', 422, "log"),
        ("[" * 5000, 400, "not-json"),
    ],
)
def test_a_mapping_that_cannot_be_used_is_refused(client, mapping, status, kind):
    answer = client.post("/v1/logs", content=table(), headers=CSV, params={"mapping": mapping})
    assert_problem(answer, status, kind)


def test_a_content_type_that_no_log_has_is_refused_with_the_known_ones(client):
    for headers in ({"Content-Type": "application/pdf"}, {}):
        answer = client.post("/v1/logs", content=table(), headers=headers)
        assert "text/csv" in assert_problem(answer, 415, "unsupported-media-type")["evidence"]["known"]


def test_an_upload_that_is_too_large_is_refused_by_its_declared_and_by_its_real_length(client):
    def endless():
        for _ in range(100):
            yield b"x" * 100_000

    for content in (b"x" * 5_000_000, endless()):
        assert_problem(client.post("/v1/logs", content=content, headers=CSV), 413, "too-large")
    large = {"file": ("log.csv", b"x" * 11_000_000, "text/csv")}
    assert_problem(client.post("/v1/logs", files=large), 413, "too-large")


def test_a_body_that_is_coded_is_refused_with_what_to_send_instead(client):
    for coding in ("gzip", "br, identity", "GZIP"):
        answer = client.post(
            "/v1/logs", content=gzip.compress(b"x"), headers=CSV | {"Content-Encoding": coding}
        )
        problem = assert_problem(answer, 415, "unsupported-media-type")
        assert problem["evidence"] == {"content_encoding": coding.lower()}
        assert answer.headers["accept-encoding"] == "identity"
    plain = CSV | {"Content-Encoding": "Identity"}
    assert client.post("/v1/logs", content=csv_log(seconds=2.0), headers=plain).status_code == 201


def test_a_file_in_a_form_may_be_as_large_as_a_body_and_no_larger(client):
    content = csv_log(seconds=2.0).rstrip()
    largest = content + (b"\n#" + b"x" * 998) * ((4_000_000 - len(content)) // 1000)
    largest += b"\n" * (4_000_000 - len(largest))
    larger = ("log.csv", largest + b"\n", "text/csv")
    assert_problem(client.post("/v1/logs", files={"file": larger}), 413, "too-large")
    asked = {"robot": (None, "yumi-left"), "log": larger}
    assert_problem(client.post("/v1/identify", files=asked), 413, "too-large")
    assert client.post("/v1/logs", files={"file": ("log.csv", largest, "text/csv")}).status_code == 201


def test_a_form_is_a_form_however_its_type_is_written(client):
    content = csv_log(seconds=2.0).rstrip()
    content += (b"\n#" + b"x" * 998) * ((3_999_000 - len(content)) // 1000)
    part = b'Content-Disposition: form-data; name="file"; filename="a.csv"'
    form = b"--x\r\n" + part + b"\r\nX: " + b"x" * 2000 + b"\r\n\r\n" + content + b"\r\n--x--\r\n"
    headers = {"Content-Type": "Multipart/Form-Data; boundary=x"}
    assert client.post("/v1/logs", headers=headers, content=form).status_code == 201


@pytest.mark.parametrize(
    ("headers", "content", "status"),
    [
        ({"Content-Type": "multipart/form-data"}, b"--x\r\n\r\n", 400),
        ({"Content-Type": "multipart/form-data; boundary=x"}, b"no boundary here", 400),
        ({"Content-Type": "multipart/form-data; boundary=x"}, b"--x\r\nbroken", 400),
        ({"Content-Type": "multipart/form-data; boundary=x"}, b"", 400),
    ],
)
def test_a_broken_form_is_refused(client, headers, content, status):
    for path in ("/v1/logs", "/v1/identify"):
        answer = client.post(path, headers=headers, content=content)
        assert answer.status_code in {status, 422}
        assert_problem(answer, answer.status_code, "bad-request" if answer.status_code == 400 else "request")


@pytest.mark.parametrize(
    "files",
    [
        {"other": ("log.csv", b"x", "text/csv")},
        {"file": (None, "text instead of a file")},
        [("file", ("1.csv", csv_log(seconds=2.0))), ("file", ("2.csv", csv_log(seconds=3.0)))],
        {"file": ("log.csv", b"x", "text/csv"), "surprise": (None, "1")},
        [("file", ("log.csv", b"x")), ("mapping", (None, "{}")), ("mapping", ("mapping.json", b"{}"))],
        [("file", ("log.csv", b"x")), ("mapping", ("mapping.json", b" " * (LONGEST_TEXT_FILE + 1)))],
    ],
)
def test_a_form_with_the_wrong_parts_is_refused(client, files):
    assert_problem(client.post("/v1/logs", files=files), 422, "request")


def form_of(*parts):
    """Write a form whose boundary is x, of the headers and contents of its parts."""
    written = (b"--x\r\nContent-Disposition: form-data; %b\r\n\r\n%b\r\n" % part for part in parts)
    return b"".join(written) + b"--x--\r\n"


FORM = {"Content-Type": "multipart/form-data; boundary=x"}
FILE = b'name="file"; filename="log.csv"', csv_log(seconds=2.0)
MAPPING = b'name="mapping"', b'{"nonsense": 1}'


@pytest.mark.parametrize("missing", [3, 4, 6, 20, 90])
@pytest.mark.parametrize("parts", [[FILE], [FILE, MAPPING], [MAPPING, FILE]])
def test_a_form_that_was_cut_off_is_refused_whatever_is_missing(client, parts, missing):
    answer = client.post("/v1/logs", headers=FORM, content=form_of(*parts)[:-missing])
    problem = assert_problem(answer, 400, "bad-request")
    assert problem["evidence"]["reason"] == "it ends before its last boundary"


@pytest.mark.parametrize(
    "preamble",
    [b"", b"\r\n", b"This is a form\r\nin MIME --x.\r\n", b"--xy of another\r\n", b"hello\r\n--x-inner\r\n"],
)
def test_what_stands_before_the_first_boundary_is_passed_over(client, preamble):
    answer = client.post("/v1/logs", headers=FORM, content=preamble + form_of(FILE))
    assert answer.status_code == 201, answer.text


def test_blanks_may_follow_the_first_boundary(client):
    first, rest = form_of(FILE).split(b"\r\n", 1)
    answer = client.post("/v1/logs", headers=FORM, content=first + b" \t\r\n" + rest)
    assert answer.status_code == 201, answer.text


@pytest.mark.parametrize("charset", ["hex", "punycode", "utf-16", "what"])
def test_a_form_in_anything_but_utf_8_is_refused(client, charset):
    said = {"Content-Type": f"{FORM['Content-Type']}; charset={charset}"}
    answer = client.post("/v1/logs", headers=said, content=form_of(FILE, (b'name="mapping"', b"{}")))
    problem = assert_problem(answer, 400, "bad-request")
    assert problem["evidence"]["reason"] == "its charset is not UTF-8"


def test_a_form_without_a_boundary_is_refused_before_it_fills_the_memory(client):
    answer = client.post("/v1/logs", headers=FORM, content=bytes(3_000_000))
    problem = assert_problem(answer, 400, "bad-request")
    assert problem["evidence"]["reason"] == "no boundary is in its first 65536 bytes"


def test_a_text_that_is_no_utf_8_is_refused(client):
    mapping = b'name="mapping"', '{"torque": {"unit": "N\u00b7m"}}'.encode("latin-1")
    answer = client.post("/v1/logs", headers=FORM, content=form_of(FILE, mapping))
    assert "utf-8" in assert_problem(answer, 400, "bad-request")["evidence"]["reason"]


def test_a_form_may_end_with_its_last_boundary(client):
    assert client.post("/v1/logs", headers=FORM, content=form_of(FILE)[:-2]).status_code == 201


def test_a_form_with_too_many_parts_is_refused(client):
    files = [(f"part{n}", (None, "1")) for n in range(200)]
    assert_problem(client.post("/v1/logs", files=files), 400, "bad-request")


# ----------------------------------------------------------------------------------------------------- robots


def without(name):
    broken = description()
    broken["joints"][1] = {key: value for key, value in broken["joints"][1].items() if key != name}
    return json.dumps(broken)


def with_(joint=None, **fields):
    changed = description() | fields
    if joint is not None:
        changed["joints"][0] = changed["joints"][0] | joint
    return json.dumps(changed)


BAD_ROBOTS = {
    "nothing": ("", 400, "not-json"),
    "no object": ("[]", 422, "robot"),
    "a field is missing": (without("alpha"), 422, "robot"),
    "false for a number": (with_({"alpha": False}), 422, "robot"),
    "text for a number": (with_({"d": "0.5"}), 422, "robot"),
    "an unknown field": (with_({"theta": 0.0}), 422, "robot"),
    "an unknown type": (with_({"type": "magnetic"}), 422, "robot"),
    "a joint that carries itself": (with_({"antecedent": 1}), 422, "robot"),
    "no joints": (with_(joints=[]), 422, "robot"),
    "too many joints": (with_(joints=description()["joints"] * 40), 422, "robot"),
    "two numbers of gravity": (with_(gravity=[0.0, -9.81]), 422, "robot"),
    "an unknown convention": (with_(convention="craig"), 422, "robot"),
    "NaN": (with_({"alpha": float("nan")}), 400, "not-json"),
    "infinity": (with_({"d": float("inf")}), 400, "not-json"),
    "a number beyond floats": (with_().replace("0.4", "1e400"), 400, "not-json"),
    "an integer beyond floats": (with_().replace("0.4", "1" + "0" * 400), 422, "robot"),
    "cut short": (with_()[:-5], 400, "not-json"),
    "a name twice": ('{"name": "a", "name": "b", "joints": []}', 400, "not-json"),
    "half a character": (with_(name="\ud800"), 400, "not-json"),
    "deep nesting": ('{"name": ' + "[" * 100_000 + "]" * 100_000 + "}", 400, "not-json"),
    "nesting": ('{"name": ' + "[" * 40 + "]" * 40 + "}", 400, "not-json"),
    "not UTF-8": (b'{"name": "\xff"}', 400, "not-json"),
}


@pytest.mark.parametrize(("content", "status", "kind"), BAD_ROBOTS.values(), ids=BAD_ROBOTS.keys())
def test_a_description_that_cannot_be_used_is_refused(client, content, status, kind):
    assert_problem(client.post("/v1/robots", content=content, headers=JSON), status, kind)


def test_a_missing_field_is_named_with_its_place(client):
    problem = client.post("/v1/robots", content=without("alpha"), headers=JSON).json()
    assert problem["evidence"]["pointer"].startswith("/joints/1")
    assert "alpha" in problem["cause"]


BOMB = '<!DOCTYPE r [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;">]><robot name="&b;"><link name="l"/></robot>'
JOINT = '<joint name="{0}" type="revolute"><parent link="{1}"/><child link="{2}"/><axis xyz="0 0 1"/></joint>'
BAD_URDFS = {
    "nothing": "",
    "no XML": "robot: {}",
    "cut short": "<robot><link",
    "another root": "<mujoco/>",
    "an entity bomb": BOMB,
    "an outside entity": '<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/hostname">]><robot name="&x;"/>',
    "xacro": '<robot xmlns:xacro="http://ros.org/wiki/xacro"><xacro:arm/></robot>',
    "a cycle": '<robot name="r"><link name="a"/><link name="b"/>'
    + JOINT.format("j1", "a", "b")
    + JOINT.format("j2", "b", "a")
    + "</robot>",
    "a parent that does not exist": '<robot name="r"><link name="b"/>'
    + JOINT.format("j1", "a", "b")
    + "</robot>",
    "nothing that moves": '<robot name="r"><link name="a"/></robot>',
    "NaN": '<robot name="r"><link name="a"/><link name="b"/>'
    + JOINT.format("j1", "a", "b").replace("0 0 1", "0 nan 1")
    + "</robot>",
    "deep nesting": "<robot>" + "<a>" * 50_000 + "</a>" * 50_000 + "</robot>",
}


@pytest.mark.parametrize("content", BAD_URDFS.values(), ids=BAD_URDFS.keys())
def test_a_urdf_that_cannot_be_used_is_refused(client, content):
    assert_problem(client.post("/v1/robots", content=content, headers=XML), 422, "robot")


@pytest.mark.parametrize("gravity", ["down", "0,0", "nan,0,-9.81", "1e400,0,0"])
def test_gravity_that_is_no_vector_is_refused(client, gravity):
    answer = client.post("/v1/robots", params={"gravity": gravity}, content="<robot/>", headers=XML)
    assert answer.status_code == 422
    assert_problem(answer, 422, answer.json()["type"].rsplit(":", 1)[1])


def test_a_description_of_another_content_type_is_refused(client):
    for kind in ("text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x"):
        answer = client.post("/v1/robots", content=with_(), headers={"Content-Type": kind})
        assert_problem(answer, 415, "unsupported-media-type")


def test_a_document_that_is_too_large_is_refused(client):
    answer = client.post("/v1/robots", content=b" " * 7_000_000, headers=JSON)
    assert_problem(answer, 413, "too-large")


# ------------------------------------------------------------------------------------------------------- jobs

GOOD_JOB = {"kind": "identify", "robot": "yumi-left", "logs": ["log-none"], "options": {}}


@pytest.mark.parametrize(
    ("change", "pointer"),
    [
        ({"kind": "guess"}, "/kind"),
        ({"kind": None}, "/kind"),
        ({"robot": 7}, "/robot"),
        ({"robot": "x" * 100}, "/robot"),
        ({"logs": "log-none"}, "/logs"),
        ({"logs": ["a"] * 101}, "/logs"),
        ({"logs": [None]}, "/logs/0"),
        ({"options": []}, "/options"),
        ({"path": "/etc/passwd"}, "/path"),
    ],
)
def test_a_job_request_that_does_not_follow_the_contract_is_refused_at_the_spot(client, change, pointer):
    problem = assert_problem(client.post("/v1/jobs", json=GOOD_JOB | change), 422, "request")
    assert pointer in [spot["pointer"] for spot in problem["evidence"]["errors"]]


def test_an_unknown_kind_of_job_is_refused_with_the_known_ones(client):
    problem = client.post("/v1/jobs", json=GOOD_JOB | {"kind": "guess"}).json()
    message = problem["evidence"]["errors"][0]["message"]
    assert all(f"'{kind}'" in message for kind in KINDS)


def test_a_job_without_a_log_is_refused_where_its_kind_needs_one(client):
    problem = assert_problem(client.post("/v1/jobs", json=GOOD_JOB | {"logs": []}), 422, "request")
    assert "/logs" in str(problem["evidence"])


def test_a_robot_or_log_that_does_not_exist_is_named(client, log_id):
    problem = assert_problem(client.post("/v1/jobs", json=GOOD_JOB), 422, "unknown-reference")
    assert problem["evidence"] == {"log": "log-none"}
    body = GOOD_JOB | {"robot": "nobody", "logs": [log_id]}
    assert_problem(client.post("/v1/jobs", json=body), 422, "unknown-reference")


def test_an_unknown_option_is_refused_with_the_known_ones(client, robot_id, log_id):
    body = {"kind": "identify", "robot": robot_id, "logs": [log_id], "options": {"mood": "good"}}
    problem = assert_problem(client.post("/v1/jobs", json=body), 422, "option")
    assert "estimator" in json.dumps(problem["evidence"])


def test_a_robot_with_other_joints_than_the_log_is_refused(client, log_id):
    problem = assert_problem(client.post("/v1/jobs", json=GOOD_JOB | {"logs": [log_id]}), 422, "log")
    assert (problem["evidence"]["log_joints"], problem["evidence"]["robot_joints"]) == (2, 7)


@pytest.mark.parametrize(
    "content",
    ['{"options": {"a": NaN}}', '{"options": ' + "[" * 100_000, "", "null {}", '{"a": 1, "a": 1}', "\x00"],
)
def test_a_job_request_that_is_no_json_is_refused(client, content):
    assert_problem(client.post("/v1/jobs", content=content, headers=JSON), 400, "not-json")


@pytest.mark.parametrize(
    ("parts", "status", "kind"),
    [
        ({"robot": (None, "yumi-left")}, 422, "request"),
        ({"log": ("a.csv", b"x", "text/csv")}, 422, "request"),
        ({"robot": (None, "nobody"), "log": ("a.csv", b"x", "text/csv")}, 422, "unknown-reference"),
        ({"robot": (None, "{"), "log": ("a.csv", b"x", "text/csv")}, 400, "not-json"),
        ({"robot": (None, "<robot>"), "log": ("a.csv", b"x", "text/csv")}, 422, "robot"),
        ({"robot": (None, "yumi-left"), "log": ("a.csv", b"", "text/csv")}, 422, "log"),
        ({"robot": (None, "yumi-left"), "log": (None, "not a file")}, 422, "request"),
        ({"robot": (None, "yumi-left"), "log": ("a", b"x"), "options": (None, "{")}, 400, "not-json"),
        ({"robot": (None, "yumi-left"), "log": ("a", b"x"), "depth": (None, "1")}, 422, "request"),
    ],
)
def test_a_one_shot_request_that_cannot_be_used_is_refused(client, parts, status, kind):
    assert_problem(client.post("/v1/identify", files=parts), status, kind)


# -------------------------------------------------------------------------------------------------- addresses


@pytest.mark.parametrize(
    "odd", ["%00", "..%2f..", "'; drop table jobs", "%ff%fe", "x" * 5000, "%F0%9F%A4%96", "*"]
)
def test_an_id_of_odd_characters_is_not_found(client, odd):
    for path in ("robots", "logs", "jobs"):
        assert_problem(client.get(f"/v1/{path}/{odd}"), 404, "not-found")
        assert_problem(client.delete(f"/v1/{path}/{odd}"), 404, "not-found")
    for tail in ("results", "results/parameters.csv"):
        assert_problem(client.get(f"/v1/jobs/{odd}/{tail}"), 404, "not-found")
    assert_problem(client.get(f"/v1/robots/{odd}/base-parameters"), 404, "not-found")


@pytest.mark.parametrize(
    "query",
    ["limit=0", "limit=many", "limit=1001", "cursor=-1", "limit=1e3", "cursor=1" + "0" * 30, "cursor=x"],
)
def test_a_page_that_cannot_be_is_refused(client, query):
    for path in ("robots", "logs", "jobs"):
        problem = assert_problem(client.get(f"/v1/{path}?{query}"), 422, "request")
        assert problem["evidence"]["errors"][0]["parameter"] == query.split("=")[0]
