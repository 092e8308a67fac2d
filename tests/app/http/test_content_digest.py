"""A body whose digest is announced is taken as announced, or not at all."""

import base64
import hashlib

import pytest

from tests.app.conftest import assert_problem
from tests.app.planar_arm import description


def digest(content, name="sha-256"):
    algorithm = {"sha-256": "sha256", "sha-512": "sha512"}[name]
    return f"{name}=:{base64.b64encode(hashlib.new(algorithm, content).digest()).decode()}:"


def upload(client, content, announced):
    headers = {"Content-Type": "text/csv", "Content-Digest": announced}
    return client.post("/v1/logs", content=content, headers=headers)


@pytest.mark.parametrize("name", ["sha-256", "sha-512"])
def test_a_log_that_arrives_as_announced_is_taken(client, log_bytes, name):
    assert upload(client, log_bytes, digest(log_bytes, name)).status_code == 201


@pytest.mark.parametrize("name", ["sha-256", "sha-512"])
def test_a_log_that_was_corrupted_on_the_way_is_refused_and_not_kept(client, log_bytes, name):
    spoilt = log_bytes.replace(b"0", b"1", 1)
    problem = assert_problem(upload(client, spoilt, digest(log_bytes, name)), 400, "digest")
    assert problem["evidence"]["algorithm"] == name
    assert f":{problem['evidence']['arrived']}:" in digest(spoilt, name)


def test_all_digests_that_are_announced_have_to_agree(client, log_bytes):
    both = f"{digest(log_bytes)}, {digest(b'other', 'sha-512')}"
    assert_problem(upload(client, log_bytes, both), 400, "digest")


def test_an_algorithm_that_is_not_known_is_passed_over(client, log_bytes):
    assert upload(client, log_bytes, "unixsum=:AAA=:, md5=:AAAA:").status_code == 201


@pytest.mark.parametrize("ending", ["=:;q=1", '=: ; a;b="c"', ":"])
def test_a_digest_may_have_parameters_and_needs_no_padding(client, log_bytes, ending):
    right, wrong = (digest(content).removesuffix("=:") + ending for content in (log_bytes, b"other"))
    assert upload(client, log_bytes, right).status_code == 201
    assert_problem(upload(client, log_bytes, wrong), 400, "digest")


@pytest.mark.parametrize(
    "header", ["", "sha-256", "sha-256=AAAA", "sha-256=:AAAA", "sha-256=:A:", ";", "sha-256=:é:"]
)
def test_a_header_that_is_not_written_as_the_standard_demands_is_refused(client, log_bytes, header):
    assert_problem(upload(client, log_bytes, header.encode()), 400, "digest")


def test_a_body_that_comes_piece_by_piece_is_hashed_as_a_whole(client, log_bytes):
    pieces = (log_bytes[begin : begin + 1000] for begin in range(0, len(log_bytes), 1000))
    assert upload(client, pieces, digest(log_bytes)).status_code == 201


def test_documents_and_forms_are_checked_as_well(client, log_bytes):
    headers = {"Content-Digest": digest(b"something else")}
    assert_problem(client.post("/v1/robots", json=description(), headers=headers), 400, "digest")
    form = {"file": ("log.csv", log_bytes, "text/csv")}
    assert_problem(client.post("/v1/logs", files=form, headers=headers), 400, "digest")
