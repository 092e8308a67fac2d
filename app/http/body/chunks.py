"""Hold what arrives as it came: no body is copied on its way but once."""

from typing import Self


class Pieces:
    """Hold a body as it came, piece by piece: uvicorn copies each into an array, and out of it again."""

    def __init__(self) -> None:
        self._pieces: list[bytes] = []
        self._size = 0

    def __iadd__(self, piece: bytes) -> Self:
        """Take a piece."""
        self._pieces.append(piece)
        self._size += len(piece)
        return self

    def __len__(self) -> int:
        """Count the bytes."""
        return self._size

    def __bytes__(self) -> bytes:
        """Give all pieces; one alone as it is."""
        return self._pieces[0] if len(self._pieces) == 1 else b"".join(self._pieces)
