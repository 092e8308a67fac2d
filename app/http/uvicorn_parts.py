"""Replace two parts that uvicorn's connections hold: the body of a request, and the way to its answer."""

import asyncio
from collections.abc import Callable
from typing import Self


class BodyChunks:
    """Hold a body in the chunks in which it came, where uvicorn copies each into an array and out again."""

    def __init__(self) -> None:
        self._chunks: list[bytes] = []
        self._size = 0

    def __iadd__(self, chunk: bytes) -> Self:
        """Append a chunk."""
        self._chunks.append(chunk)
        self._size += len(chunk)
        return self

    def __len__(self) -> int:
        """Count the bytes."""
        return self._size

    def __bytes__(self) -> bytes:
        """Join the chunks; a single one is not copied."""
        return self._chunks[0] if len(self._chunks) == 1 else b"".join(self._chunks)


class AnswerTransport:
    """Write answers to a transport, and call something else where the answer closes it."""

    def __init__(self, transport: asyncio.Transport, close: Callable[[], None]) -> None:
        self.write, self.is_closing, self.close = transport.write, transport.is_closing, close
