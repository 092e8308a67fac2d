"""Receive files: streamed to the disk while they are hashed, never in memory as a whole."""

import asyncio
from collections import deque
from collections.abc import AsyncIterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import asynccontextmanager

import anyio
from python_multipart.exceptions import FormParserError
from starlette.datastructures import FormData, UploadFile
from starlette.formparsers import MultiPartException
from starlette.requests import ClientDisconnect, Request

from ....core.log.formats.content import FORMS, NO_CLAIM
from ...problems import Problem
from ...store.blobs.incoming import Incoming
from ..refusals import too_large
from .multipart import parse_form

MULTIPART = "multipart/form-data"
LOG_MEDIA_TYPES = (*sorted({kind for form in FORMS for kind in form.media_types}), "application/octet-stream")
MOST_PARTS = 32
LONGEST_TEXT_FILE = 256 * 1024
PIECE = 1 << 20
AHEAD = 2
"""BodyChunks that may wait to be written, for each upload."""


async def receive_body(request: Request, incoming: Incoming) -> None:
    """Write the body of a request aside.

    Raises
    ------
    Problem
        If the client went away meanwhile (400).
    """
    waiting, size = list[bytes](), 0
    writing: deque[asyncio.Future[None]] = deque()  # pieces are hashed and written while the next ones arrive
    with ThreadPoolExecutor(1, thread_name_prefix="upload") as writer:
        try:
            async for piece in request.stream():
                waiting.append(piece)
                size += len(piece)
                if size >= PIECE:
                    writing.append(asyncio.wrap_future(writer.submit(_write, incoming, waiting)))
                    waiting, size = [], 0
                if len(writing) > AHEAD:
                    await writing.popleft()
            writing.append(asyncio.wrap_future(writer.submit(_write, incoming, waiting)))
            while writing:
                await writing.popleft()
        except ClientDisconnect:
            raise Problem("bad-request", "the upload ended early", remedy="send it again") from None
        finally:
            await asyncio.gather(*writing, return_exceptions=True)


def _write(incoming: Incoming, pieces: list[bytes]) -> None:
    incoming.write(b"".join(pieces))


async def receive_part(part: UploadFile, incoming: Incoming) -> None:
    """Write an uploaded part aside."""
    while piece := await part.read(PIECE):
        await anyio.to_thread.run_sync(incoming.write, piece)


@asynccontextmanager
async def open_form(request: Request, *, longest_text: int) -> AsyncIterator[FormData]:
    """Read a multipart form; large parts wait on the disk and are gone at the end.

    Raises
    ------
    Problem
        If the body is no form (400), or a file in it larger than the service takes (413).
    """
    try:
        form = await parse_form(request, most_parts=MOST_PARTS, longest_text=longest_text)
    except Problem:
        raise
    except (MultiPartException, FormParserError, ClientDisconnect, ValueError, KeyError) as error:
        reason = getattr(error, "message", str(error)) or type(error).__name__
        raise Problem(
            "bad-request",
            "the body is no multipart form that can be read",
            evidence={"reason": reason},
            remedy=f"send {MULTIPART} with a boundary and at most {MOST_PARTS} parts, as curl -F does",
        ) from None
    try:
        _refuse_large_files(form, request.app.state.services.settings.max_upload_bytes)
        yield form
    finally:
        await form.close()


def _refuse_large_files(form: FormData, limit: int) -> None:
    for _, part in form.multi_items():
        if isinstance(part, UploadFile) and (part.size or 0) > limit:
            raise too_large(limit)


def refuse_unknown_parts(form: FormData, known: tuple[str, ...]) -> None:
    """Refuse parts that the contract does not name.

    Raises
    ------
    Problem
        If there is one (422).
    """
    unknown = sorted({name for name in form if name not in known})
    if unknown:
        raise Problem(
            "request",
            f"the form has a part that does not exist: {unknown[0]}",
            evidence={"unknown": unknown, "known": list(known)},
            remedy="leave it out or name it as one of the known parts",
        )


def files_of(form: FormData, name: str) -> list[UploadFile]:
    """Give the files of a form under one name.

    Raises
    ------
    Problem
        If there is none, or one of them is plain text (422).
    """
    given = form.getlist(name)
    files = [part for part in given if isinstance(part, UploadFile)]
    if not files or len(files) < len(given):
        raise Problem(
            "request",
            f"the form holds no file named {name}" if not files else f"a part named {name} is no file",
            evidence={"parts": sorted(set(form))},
            remedy=f"attach the file, as curl -F {name}=@log.csv does",
        )
    return files


def file_of(form: FormData, name: str) -> UploadFile:
    """Give the one file of a form under a name.

    Raises
    ------
    Problem
        If there is none, several, or plain text (422).
    """
    files = files_of(form, name)
    if len(files) > 1:
        raise Problem(
            "request",
            f"the form holds several files named {name}",
            evidence={"count": len(files)},
            remedy="send each in a request of its own",
        )
    return files[0]


async def text_of(form: FormData, name: str) -> bytes | str | None:
    """Give a text part of a form, which may come as a file; None where there is none.

    Raises
    ------
    Problem
        If it is given twice, or as a file that is too large (422).
    """
    given = form.getlist(name)
    if len(given) > 1:
        raise Problem(
            "request",
            f"the form holds several parts named {name}",
            evidence={"count": len(given)},
            remedy="send it once, as text or as a file",
        )
    part = given[0] if given else None
    if not isinstance(part, UploadFile):
        return part
    content = await part.read(LONGEST_TEXT_FILE + 1)
    if len(content) > LONGEST_TEXT_FILE:
        raise Problem(
            "request",
            f"the file of the part {name} is larger than {LONGEST_TEXT_FILE} bytes",
            evidence={"limit_bytes": LONGEST_TEXT_FILE},
            remedy="make sure that it is the file you mean: it holds JSON, and little of it",
        )
    return content


def claimed_type(part: UploadFile) -> str | None:
    """Give the media type that a part claims, where logs come in it; other claims are guesses."""
    claim = (part.content_type or "").split(";")[0].strip().lower()
    return claim if claim in LOG_MEDIA_TYPES and claim not in NO_CLAIM else None
