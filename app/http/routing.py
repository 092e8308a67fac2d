"""Check requests against their route's contract, and call simple endpoints directly.

The framework ignores query parameters that it does not know, so that a misspelt one would have no effect. It
also determines again at every request what an endpoint takes. Where that is nothing but plain
strings and the caller's context, the endpoint is called straight away, because clients poll jobs thousands of
times a second.
"""

from collections import Counter
from collections.abc import Callable, Coroutine, Iterator, Mapping
from inspect import iscoroutinefunction
from typing import Any
from urllib.parse import parse_qsl

from fastapi import APIRouter, Request, Response
from fastapi.dependencies.models import Dependant
from fastapi.routing import APIRoute

from ..problems import Problem
from ..services.services import context_of
from .body.json_body import invalid

Handler = Callable[[Request], Coroutine[Any, Any, Response]]
MOST_PARAMETERS = 100


def chapter(prefix: str = "", *, tag: str) -> APIRouter:
    """Make the router of one resource."""
    return APIRouter(
        prefix=prefix,
        tags=[tag],
        route_class=StrictRoute,
        generate_unique_id_function=lambda route: (
            route.name
        ),  # short names for clients and for links to /docs
    )


class StrictRoute(APIRoute):
    """Answer requests that name only what the contract names."""

    def get_route_handler(self) -> Handler:
        """Give what answers a request."""
        answer = _direct_handler(self.dependant) or super().get_route_handler()
        known = frozenset(_query_names(self.dependant))

        async def strict(request: Request) -> Response:
            if request.scope["query_string"]:
                refuse_unknown_parameters(request.scope["query_string"], known)
            return await answer(request)

        return strict


def refuse_unknown_parameters(query: bytes, known: frozenset[str]) -> None:
    """Refuse parameters of a query that do not exist, or are given twice.

    Raises
    ------
    Problem
        If there is one (422).
    """
    try:
        pairs = parse_qsl(query.decode("latin-1"), keep_blank_values=True, max_num_fields=MOST_PARAMETERS)
    except ValueError:
        raise _refusal({"": f"there are more than {MOST_PARAMETERS} parameters"}, known) from None
    given = Counter(name for name, _ in pairs)
    wrong = {name: f"there is no parameter {name}" for name in given if name not in known}
    wrong |= {name: f"the parameter {name} is given twice" for name in given if given[name] > 1}
    if wrong:
        raise _refusal(wrong, known)


def _refusal(wrong: Mapping[str, str], known: frozenset[str]) -> Problem:
    errors = [{"parameter": name, "message": message} for name, message in wrong.items()]
    return Problem(
        "request",
        errors[0]["message"],
        evidence={"errors": errors, "known": sorted(known)},
        remedy="send the known parameters only, each once" if known else "send no parameters",
    )


def _query_names(dependant: Dependant) -> Iterator[str]:
    """Name the parameters of an endpoint's query, those of what it depends on included."""
    yield from (field.alias for field in dependant.query_params)
    for inner in dependant.dependencies:
        yield from _query_names(inner)


def _headers(dependant: Dependant, request: Request) -> dict[str, object]:
    """Read the headers that an endpoint takes; None for those that are missing.

    Raises
    ------
    Problem
        If one is not what the contract allows (422).
    """
    taken: dict[str, object] = {}
    for field in dependant.header_params:
        given = request.headers.get(field.alias)
        if given is not None:
            given, errors = field.validate(given, {}, loc=("header", field.alias))
            if errors:
                raise invalid(errors)
        taken[field.name] = given
    return taken


def _takes_more(dependant: Dependant) -> bool:
    more = dependant.query_params or dependant.cookie_params or dependant.body_params
    return bool(more) or any(inner.call is not context_of for inner in dependant.dependencies)


def _direct_handler(dependant: Dependant) -> Handler | None:
    """Give what calls an endpoint straight away; None where it takes more than strings and the context."""
    endpoint = dependant.call
    if _takes_more(dependant) or not iscoroutinefunction(endpoint):
        return None
    contexts = [str(inner.name) for inner in dependant.dependencies]
    request_name = dependant.request_param_name

    async def answer(request: Request) -> Response:
        taken: dict[str, Any] = request.path_params | _headers(dependant, request)
        for name in contexts:
            taken[name] = await context_of(request)
        if request_name is not None:
            taken[request_name] = request
        answered: Response = await endpoint(**taken)
        return answered

    return answer
