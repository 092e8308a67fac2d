"""Read JSON from outside strictly, and check it against the models of the contract.

RFC 8259 leaves room for NaN, a name twice and any depth; here all of them are refused on arrival, with the
reason.
"""

import json
import math
from collections.abc import Iterable
from typing import NoReturn, TypeVar

from pydantic import BaseModel, ValidationError
from starlette.requests import Request

from ...problems import Problem

MOST_LEVELS = 32
LONGEST_REASON = 300
Model = TypeVar("Model", bound=BaseModel)


def media_type_of(request: Request) -> str:
    """Give the media type of the body without its parameters, in lower case; empty where none was sent."""
    return request.headers.get("content-type", "").split(";")[0].strip().lower()


def require_media_type(request: Request, known: tuple[str, ...]) -> str:
    """Give the media type of the body.

    Raises
    ------
    Problem
        If it is none of the known ones (415).
    """
    given = media_type_of(request)
    if given not in known:
        raise Problem(
            "unsupported-media-type",
            f"the content type {given or '(none)'} is not known here",
            evidence={"given": given, "known": list(known)},
            remedy="set the Content-Type header to one of the known types",
            headers={"Accept-Post": ", ".join(known)},
        )
    return given


def parse_json(text: bytes | str, *, what: str = "the body") -> object:
    """Read JSON from outside.

    Raises
    ------
    Problem
        If it is no JSON, or holds NaN, Infinity, a name twice, half a character, or too many levels (400).

    Examples
    --------
    >>> parse_json('{"cutoff_hz": 10}')
    {'cutoff_hz': 10}
    """
    try:
        decoded = text.decode() if isinstance(text, bytes) else text
        document = json.loads(
            decoded.removeprefix("\ufeff"),
            parse_constant=_refuse_constant,
            parse_float=_finite,
            object_pairs_hook=_refuse_twins,
        )
        # Half a surrogate pair is valid JSON, yet no text that could be stored or sent again.
        json.dumps(document, ensure_ascii=False).encode()
    except RecursionError:
        raise _not_json(what, f"it is nested deeper than {MOST_LEVELS} levels") from None
    except ValueError as error:
        raise _not_json(what, str(error)[:LONGEST_REASON]) from None
    if _levels(document) > MOST_LEVELS:
        raise _not_json(what, f"it is nested deeper than {MOST_LEVELS} levels")
    return document


def parse_object(text: bytes | str | None, *, what: str) -> dict[str, object] | None:
    """Read a JSON object; an absent or empty one is None.

    Raises
    ------
    Problem
        If it is no JSON (400) or no object (422).
    """
    if text is None or not text.strip():
        return None
    document = parse_json(text, what=what)
    if not isinstance(document, dict):
        raise Problem(
            "request",
            f"{what} is not a JSON object",
            evidence={"given": type(document).__name__},
            remedy="send an object such as {}",
        )
    return document or None


def check(model: type[Model], document: object) -> Model:
    """Check a document against a model of the contract.

    Raises
    ------
    Problem
        Naming every spot that does not fit by its JSON pointer (422).
    """
    try:
        return model.model_validate(document, strict=True)
    except ValidationError as error:
        complaints = error.errors(include_url=False, include_context=False)
        raise invalid({**error, "loc": ("body", *error["loc"])} for error in complaints) from None


def invalid(errors: Iterable[object]) -> Problem:
    """Turn complaints into one problem; their first place is body, query, path or header, as FastAPI says."""
    spots = [_spot(error) for error in errors if isinstance(error, dict)]
    first = spots[0] if spots else {"message": "it does not fit"}
    where = first.get("pointer") or first.get("parameter") or "the body"
    return Problem(
        "request",
        f"the request does not follow the contract at {where}: {first['message']}",
        evidence={"errors": spots},
        remedy="correct these spots; /docs shows what each must hold",
    )


def _spot(error: dict[str, object]) -> dict[str, object]:
    path = error.get("loc")
    location = [str(step) for step in path] if isinstance(path, tuple | list) else []
    spot: dict[str, object] = {"message": str(error.get("msg", ""))[:LONGEST_REASON]}
    if location[:1] == ["body"]:
        steps = (step.replace("~", "~0").replace("/", "~1") for step in location[1:])
        spot["pointer"] = "".join("/" + step for step in steps)
    else:
        spot["parameter"] = "/".join(location[1:])
    given = error.get("input")
    spot["given"] = given if isinstance(given, str | int | float | bool | None) else type(given).__name__
    return spot


def _refuse_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is no JSON number")


def _finite(digits: str) -> float:
    value = float(digits)
    if not math.isfinite(value):
        raise ValueError(f"the number {digits[:20]} is too large")
    return value


def _refuse_twins(pairs: list[tuple[str, object]]) -> dict[str, object]:
    members: dict[str, object] = {}
    for name, value in pairs:
        if name in members:
            raise ValueError(f"the name {name[:50]!r} occurs twice in one object")
        members[name] = value
    return members


def _levels(document: object) -> int:
    """Count the levels of nesting without recursion."""
    level, depth = [document], 0
    while level:
        depth += 1
        level = [child for parent in level for child in _children(parent)]
    return depth


def _children(parent: object) -> list[object]:
    if isinstance(parent, dict):
        return list(parent.values())
    return parent if isinstance(parent, list) else []


def _not_json(what: str, reason: str) -> Problem:
    return Problem(
        "not-json",
        f"{what} is not JSON that can be used",
        evidence={"reason": reason},
        remedy="send JSON (RFC 8259) in UTF-8 with finite numbers, every name once, at most "
        f"{MOST_LEVELS} levels deep",
    )
