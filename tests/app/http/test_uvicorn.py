"""The service extends uvicorn by names that uvicorn does not promise to keep: here they are, each checked.

uvicorn is pinned to one version. Whoever raises it runs this file first: it names what is gone.
"""

import ast
import asyncio
import inspect
import tomllib
from importlib.metadata import version
from pathlib import Path

import pytest
import uvicorn
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol, RequestResponseCycle
from uvicorn.server import ServerState

from veritorque.app.http import connection

ROOT = Path(__file__).parents[3]
PROTOCOL = {
    "_start_asgi_task", "_unset_keepalive_if_required", "access_logger",
    "connection_lost", "connection_made", "cycle", "flow", "headers", "logger", "on_body", "on_header",
    "on_headers_complete", "on_message_begin",
    "on_message_complete", "on_response_complete", "parser", "pipeline", "server_state", "transport", "url",
}  # fmt: skip  # a table
CYCLE = {
    "body", "disconnected", "keep_alive", "message_event", "response_complete", "response_started",
    "transport", "waiting_for_100_continue",
}  # fmt: skip  # a table
CYCLE_ARGUMENTS = {
    "scope", "transport", "flow", "logger", "access_logger", "access_log", "default_headers", "message_event",
    "expect_100_continue", "keep_alive", "on_response",
}  # fmt: skip  # a table
FLOW = {"pause_reading", "read_paused", "write_paused"}
SERVER = {"startup", "on_tick", "shutdown"}


@pytest.fixture
def protocol():
    """A connection of uvicorn as it is made."""
    loop = asyncio.new_event_loop()
    made = HttpToolsProtocol(uvicorn.Config(None), ServerState(), {}, _loop=loop)
    yield made
    loop.close()


def gone(names, thing):
    missing = sorted(name for name in names if not hasattr(thing, name))
    return f"uvicorn {uvicorn.__version__} has no {missing} in {type(thing).__name__}" if missing else ""


def test_a_connection_has_all_names_that_are_extended(protocol):
    protocol.pipeline, protocol.transport = [], None
    instance_only = {"cycle", "flow", "headers", "url"}  # set when a client connects or a request begins
    assert gone(PROTOCOL - instance_only, protocol) == ""
    source = inspect.getsource(HttpToolsProtocol)
    assert [name for name in instance_only if f"self.{name}" not in source] == []


def test_the_cycle_of_a_request_has_all_names_that_are_used():
    arguments = inspect.signature(RequestResponseCycle).parameters.keys()
    assert set(arguments) == CYCLE_ARGUMENTS, "RequestResponseCycle takes other arguments"
    cycle = RequestResponseCycle(**dict.fromkeys(CYCLE_ARGUMENTS))
    assert gone(CYCLE, cycle) == ""


def test_flow_control_and_server_have_all_names_that_are_used():
    from uvicorn.protocols.http.flow_control import FlowControl

    assert gone(FLOW, FlowControl(None)) == ""
    assert gone(SERVER, uvicorn.Server(uvicorn.Config(None))) == ""
    assert gone({"connections", "default_headers"}, ServerState()) == ""


def test_the_list_holds_every_name_that_a_connection_takes_from_uvicorn():
    tree = ast.parse(Path(connection.__file__).read_text(encoding="utf-8"))
    (own,) = [node for node in tree.body if isinstance(node, ast.ClassDef)]
    used = {node.attr for node in ast.walk(own) if isinstance(node, ast.Attribute) and _is_self(node.value)}
    ours = {node.name for node in own.body if isinstance(node, ast.FunctionDef)}
    ours |= {node.target.id for node in own.body if isinstance(node, ast.AnnAssign)}
    ours |= {target.id for node in own.body if isinstance(node, ast.Assign) for target in node.targets}
    overridden = {name for name in ours if hasattr(HttpToolsProtocol, name)}
    assert (used - ours) | overridden == PROTOCOL | {"data_received", "eof_received", "_answer_transport"}


def test_the_version_that_is_installed_is_the_one_that_is_pinned():
    required = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
    assert f"uvicorn=={version('uvicorn')}" in required


def _is_self(node):
    calls_super = isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "super"
    return calls_super or (isinstance(node, ast.Name) and node.id == "self")
