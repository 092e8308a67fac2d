"""Every block of every page: what can run runs, what cannot says why, examples follow the contract."""

import contextlib
import json
import subprocess
import threading
import time

import pytest

from tests.app.postgres import binaries, cluster, new_database
from tests.docs.blocks import BLOCKS, ROOT, blocks_of
from tests.docs.runner import DATABASE, RUN, run_page, run_page_that_serves
from veritorque.app.http.server import Server
from veritorque.app.main import create_app
from veritorque.app.schemas.common import ProblemDocument
from veritorque.app.schemas.robots import RobotDescription
from veritorque.app.settings import Settings
from veritorque.core.identification.options import parse_options

LANGUAGES = {"bash", "sh", "python", "c", "json", "xml", "text", ""}
RUN_ELSEWHERE = ("client.md", "terminal.md")
"""Their tests in tests/app run them from the first block to the last, in one session."""
RUNNABLE = [block for block in BLOCKS if block.language in RUN]
LEFT_OUT = [block for block in RUNNABLE if block.reason]
SERVING = list(dict.fromkeys(block.page for block in RUNNABLE if block.is_up))
"""Pages that start a service of their own."""
TYPED = sorted(
    dict.fromkeys(
        block.page
        for block in RUNNABLE
        if not block.reason and block.page not in SERVING and block.page.name not in RUN_ELSEWHERE
    ),
    key=lambda page: page.name == "diagnosis.md",
)
"""The page that leaves a long job behind comes last: the service ends it."""


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    """A service with the real science on a free port: its address and its data directory."""
    data = tmp_path_factory.mktemp("data")
    settings = Settings(data_dir=data, port=0)
    server = Server(create_app(settings), settings)
    thread = threading.Thread(target=server.run)
    thread.start()
    while not server.started:
        time.sleep(0.01)
    yield f"http://127.0.0.1:{server.servers[0].sockets[0].getsockname()[1]}", data
    server.should_exit = True
    thread.join()


@pytest.mark.slow
def test_what_the_pages_tell_their_readers_to_type_runs(served, tmp_path):
    """All of them in one test, so that the same job on several pages is computed once."""
    url, data = served
    for page in TYPED:
        folder = tmp_path / page.stem
        folder.mkdir()
        run_page(_typed(page), folder, url, data)


@pytest.mark.slow
@pytest.mark.parametrize("page", SERVING, ids=lambda page: page.name)
def test_a_service_that_a_page_starts_runs_until_it_is_stopped(page, tmp_path):
    with contextlib.ExitStack() as stack:
        database = new_database(stack.enter_context(cluster())) if binaries() else ""
        wanted = [block for block in _typed(page) if database or DATABASE not in block.body]
        run_page_that_serves(wanted, tmp_path, database)
    if not database:
        pytest.skip("SKIPPED FOR WANT OF POSTGRESQL: all blocks ran but those that name a database of it")


def _typed(page):
    return [one for one in blocks_of(page) if one.language in RUN and not one.reason and not one.elsewhere]


def test_what_runs_on_another_page_is_there():
    for block in BLOCKS:
        if block.elsewhere:
            assert block.body in [other.body for other in _typed(ROOT / block.elsewhere)]


@pytest.mark.parametrize("block", LEFT_OUT, ids=str)
def test_what_cannot_run_here_is_at_least_a_command(block):
    if block.language == "bash":
        assert subprocess.run(["bash", "-n", "-c", block.body], check=False).returncode == 0
    else:
        compile(block.body, str(block), "exec")
    pytest.skip(f"NOT RUN, {block}: {block.reason}")


def test_few_blocks_are_left_out():
    assert len(LEFT_OUT) <= len(RUNNABLE) / 3


@pytest.mark.parametrize("block", BLOCKS, ids=str)
def test_a_block_names_its_language_and_its_remark_is_understood(block):
    assert block.language in LANGUAGES
    assert not block.mark or block.reason or block.status or block.elsewhere or block.is_up


@pytest.mark.parametrize("block", [one for one in BLOCKS if one.language == "json"], ids=str)
def test_a_document_that_is_shown_follows_the_contract(block):
    document = json.loads(block.body)
    if "joints" in document:
        RobotDescription.model_validate_json(block.body)
    elif "remedy" in document:
        ProblemDocument.model_validate_json(block.body)
    else:
        parse_options(document)
