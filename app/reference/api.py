"""Write the reader's reference of the API from openapi.json, so that the document cannot drift.

In comes the contract as data, out goes docs/api.md: every request with what it takes and answers, every
document with its fields. `make reference` writes it, and a test compares the two.
"""

import json
import sys
from collections.abc import Iterator, Mapping
from typing import Any

Node = Mapping[str, Any]

OPENING = """\
# Requests and documents

Written by `make reference` from `openapi.json`; change the service, not this page. [The API in ten
minutes](http.md) shows the same by example; a running service shows it at `/docs`.

Every failure is a [problem document](#problemdocument) of one of the [known kinds](problems.md).
"""
_BOUNDS = {
    "minimum": "at least {}",
    "exclusiveMinimum": "above {}",
    "maximum": "at most {}",
    "minLength": "at least {} characters",
    "maxLength": "at most {} characters",
    "minItems": "at least {} entries",
    "maxItems": "at most {} entries",
}


def guide(contract: Node) -> str:
    """Write the document in Markdown."""
    asked = "".join(_chapter(contract, tag) for tag in contract["tags"])
    schemas = contract["components"]["schemas"]
    documents = "".join(_document(name, one) for name, one in schemas.items() if one.get("properties"))
    return f"{OPENING}{asked}\n## Documents\n{documents}"


def _chapter(contract: Node, tag: Node) -> str:
    told = "".join(
        _request(method, path, one)
        for path, methods in contract["paths"].items()
        for method, one in methods.items()
        if tag["name"] in one.get("tags", [])
    )
    return f"\n## {tag['name'].capitalize()}\n\n{tag['description']}\n{told}"


def _request(method: str, path: str, asked: Node) -> str:
    taken = "".join(map(_parameter, asked.get("parameters", ())))
    head = "\n| parameter | in | type | meaning |\n|---|---|---|---|\n"
    parts = [
        f"\n### {method.upper()} {path}\n\n{asked['summary']}.",
        f" {_paragraph(asked.get('description', ''))}\n",
        f"{head}{taken}" if taken else "",
        _body(asked.get("requestBody", {})),
        _answers(asked["responses"]),
    ]
    return "".join(parts)


def _parameter(one: Node) -> str:
    needed = " (needed)" if one["required"] and one["in"] != "path" else ""
    kind = _type(one["schema"])
    return f"| `{one['name']}` | {one['in']} | {kind}{needed} | {_cell(one.get('description', ''))} |\n"


def _body(body: Node) -> str:
    if not body:
        return ""
    rows = "".join(
        f"| `{media}` | {_type(one.get('schema', {}))} |\n" for media, one in body["content"].items()
    )
    return f"\n| body | holds |\n|---|---|\n{rows}"


def _answers(answers: Node) -> str:
    good = {status: one for status, one in answers.items() if status < "400"}
    rows = "".join(
        f"| {status} | {_cell(one['description'])} | {_content(one)} |\n" for status, one in good.items()
    )
    problems = ", ".join(status for status in answers if status not in good)
    told = f"\n[Problems](problems.md): {problems}.\n" if problems else ""
    return f"\n| status | when | answer |\n|---|---|---|\n{rows}{told}"


def _content(answer: Node) -> str:
    kinds = answer.get("content", {})
    return ", ".join(
        f"{_type(one['schema'])} as `{media}`" if "$ref" in one.get("schema", {}) else f"`{media}`"
        for media, one in kinds.items()
    )


def _document(name: str, schema: Node) -> str:
    needed = set(schema.get("required", ()))
    rows = "".join(
        f"| `{field}` | {_type(one)} | {'yes' if field in needed else _default(one)} | {_meaning(one)} |\n"
        for field, one in schema["properties"].items()
    )
    told = _paragraph(schema.get("description", ""))
    return f"\n### {name}\n\n{told}\n\n| field | type | always there | meaning |\n|---|---|---|---|\n{rows}"


def _default(schema: Node) -> str:
    return f"default `{json.dumps(schema['default'])}`" if "default" in schema else "no"


def _meaning(schema: Node) -> str:
    bounds = [
        words.format(one[bound])
        for one in _variants(schema)
        for bound, words in _BOUNDS.items()
        if bound in one
    ]
    return "; ".join([part for part in (_cell(schema.get("description", "")), *bounds) if part])


def _variants(schema: Node) -> Iterator[Node]:
    yield schema
    for one in schema.get("anyOf", ()):
        yield from _variants(one)


def _type(schema: Node) -> str:
    """Name what a schema allows, with a link where it is a document of its own."""
    if "$ref" in schema:
        name = schema["$ref"].rsplit("/", 1)[-1]
        return "any" if name == "JsonValue" else f"[{name}](#{name.lower()})"
    if "anyOf" in schema:
        return " or ".join(dict.fromkeys(_type(one) for one in schema["anyOf"]))
    if "enum" in schema or "const" in schema:
        return ", ".join(f"`{one}`" for one in schema.get("enum", [schema.get("const")]))
    if schema.get("type") == "array":
        return f"list of {_type(schema.get('items', {}))}"
    return _object(schema) if schema.get("type") == "object" else str(schema.get("type", "any"))


def _object(schema: Node) -> str:
    inner = schema.get("additionalProperties")
    return f"object of {_type(inner)}" if isinstance(inner, Mapping) and inner else "object"


def _paragraph(text: str) -> str:
    return "\n\n".join(" ".join(part.split()) for part in text.split("\n\n"))


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")


if __name__ == "__main__":
    sys.stdout.write(guide(json.load(sys.stdin)))
