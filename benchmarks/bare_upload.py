"""Serve what an upload costs at least: count the bytes of a body, or write them down."""

import sys
import tempfile

import uvicorn
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import PlainTextResponse
from starlette.routing import Route


async def count(request: Request) -> PlainTextResponse:
    """Let the body pass by."""
    size = 0
    async for piece in request.stream():
        size += len(piece)
    return PlainTextResponse(str(size))


async def write(request: Request) -> PlainTextResponse:
    """Write the body to a file."""
    size = 0
    with tempfile.TemporaryFile() as file:
        async for piece in request.stream():
            size += file.write(piece)
    return PlainTextResponse(str(size))


if __name__ == "__main__":
    routes = [Route("/count", count, methods=["POST"]), Route("/write", write, methods=["POST"])]
    uvicorn.run(Starlette(routes=routes), port=int(sys.argv[1]), log_level="error")
