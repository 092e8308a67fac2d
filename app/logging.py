"""Write the service's own log: one JSON object per line, or plain lines where a person sits at the terminal.

Every line carries the request, the trace and the job that it is about, wherever in the code it is written:
they are bound once, where a request arrives or a job is taken, and travel with the thread or task.
"""

import logging
import os
import sys

import structlog
from structlog.typing import EventDict, Processor, WrappedLogger

from .settings import Settings

bound = structlog.contextvars.bound_contextvars
"""Let the lines written within a ``with`` carry the given names."""


def configure_logging(settings: Settings) -> None:
    """Let all that this process logs go to its standard error, in one form."""
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(_formatter(for_people=sys.stderr.isatty()))
    root = logging.getLogger()
    root.handlers = [handler]
    root.setLevel(settings.log_level.upper())


def begin(**names: str) -> None:
    """Replace the fields that every following line carries."""
    structlog.contextvars.clear_contextvars()
    structlog.contextvars.bind_contextvars(**names)


def _formatter(*, for_people: bool) -> structlog.stdlib.ProcessorFormatter:
    before: list[Processor] = [
        structlog.contextvars.merge_contextvars,
        structlog.stdlib.add_log_level,
        structlog.stdlib.add_logger_name,
        structlog.stdlib.ExtraAdder(),
        structlog.processors.TimeStamper(fmt="iso", utc=True, key="time"),
        _with_process,
    ]
    plain = [structlog.stdlib.ProcessorFormatter.remove_processors_meta, _without_colours]
    if for_people:
        written: list[Processor] = [*plain, structlog.dev.ConsoleRenderer()]
    else:
        written = [*plain, structlog.processors.format_exc_info, structlog.processors.JSONRenderer()]
    return structlog.stdlib.ProcessorFormatter(foreign_pre_chain=before, processors=written)


def _with_process(_logger: WrappedLogger, _method: str, event: EventDict) -> EventDict:
    event["process"] = os.getpid()
    return event


def _without_colours(_logger: WrappedLogger, _method: str, event: EventDict) -> EventDict:
    event.pop("color_message", None)  # uvicorn's, for terminals
    return event
