"""Write an identified robot as YAML that every parser reads alike: quoted names, numbers with a point.

The document is mappings, lists and scalars one or two levels deep; each row is one line. YAML 1.1, which most
parsers in use still read, takes 1e-05 for a text and the torque offset OFF for the word false: the one wants
1.0e-05, the other quotes. Source: YAML 1.1 and 1.2, tag repository.
"""

import json
import textwrap
from collections.abc import Mapping

from ..document.model.caveats import caveats
from ..document.model.identified import IdentifiedRobot
from .content import content

WIDTH = 110


def write_yaml(identified: IdentifiedRobot) -> str:
    """Write the parameters as YAML, with what they are in a comment."""
    lines = [f"# {line}" for caveat in caveats(identified) for line in textwrap.wrap(caveat, WIDTH)]
    for name, value in content(identified).items():
        if isinstance(value, list) and value and not isinstance(value[0], float):
            lines += [f"{name}:", *(f"  - {_flow(entry)}" for entry in value)]
        else:
            lines.append(f"{name}: {_flow(value)}")
    return "\n".join(lines) + "\n"


def _flow(value: object) -> str:
    """Write a value on one line.

    Examples
    --------
    >>> _flow({"name": "OFF1", "value": 1e-05, "joints": [1, 2]})
    '{"name": "OFF1", "value": 1.0e-05, "joints": [1, 2]}'
    """
    if isinstance(value, Mapping):
        return "{" + ", ".join(f'"{name}": {_flow(entry)}' for name, entry in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_flow, value)) + "]"
    if isinstance(value, float):
        digits, exponent, power = repr(value).partition("e")
        return f"{digits if '.' in digits else digits + '.0'}{exponent}{power}"
    return json.dumps(value, ensure_ascii=False)
