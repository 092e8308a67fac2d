"""Write the reader's list of file formats, units and recorders from what reads and writes them.

`make reference` writes docs/formats.md, and a test compares the two.
"""

import sys

from ..log.channels import CHANNELS, Channel, Unit
from ..log.formats.content import FORMS
from ..log.profiles import PROFILES, Pattern
from .formats import FORMATS

OPENING = """\
# Formats

Written by `make reference` from what reads and writes them; change that, not this page. How a log is
handed in is told in [logs.md](logs.md), how a robot is taken home in [export.md](export.md).

## Formats of a log

The bytes decide; a media type or suffix that contradicts them is refused. The first media type of a row
is the best.

| format | media types | suffixes |
|---|---|---|
"""
UNITS_OPENING = """
## Units of a log

Columns with default names are SI by contract; every other column declares its unit. A value becomes SI
as *factor* times (value plus *shift*), after `scale` and `offset` of the mapping.

| channel | default names | unit | factor | shift |
|---|---|---|---|---|
"""
PROFILES_OPENING = """
## Recorders

`{"profile": NAME}` is a whole mapping. A joint's name or number stands in place of `{}`; where no unit
is given, the mapping has to declare it.

| profile | channel | columns |
|---|---|---|
"""
FILES_OPENING = """
## Files of a result

`GET /v1/jobs/{id}/results/NAME`

| name | media type | what it is |
|---|---|---|
"""


def guide() -> str:
    """Write the document in Markdown."""
    forms = "".join(
        f"| {form.name} | {_listed(form.media_types)} | {_listed(form.suffixes)} |\n" for form in FORMS
    )
    units = "".join(_unit(channel, unit) for channel in CHANNELS.values() for unit in channel.quantity.units)
    profiles = "".join(_profile(name) for name in PROFILES)
    files = "".join(f"| `{name}` | `{one.media_type}` | {one.title} |\n" for name, one in FORMATS.items())
    return f"{OPENING}{forms}{UNITS_OPENING}{units}{PROFILES_OPENING}{profiles}{FILES_OPENING}{files}"


def _unit(channel: Channel, unit: Unit) -> str:
    names = f"`{channel.prefix}_1`, ..." if channel.per_joint else f"`{channel.prefix}`"
    factor = "given by `scale`" if unit.needs_scale else f"{unit.factor:.10g}"
    return f"| {channel.name} | {names} | `{unit.name}` | {factor} | {unit.offset:.10g} |\n"


def _profile(name: str) -> str:
    profile = PROFILES[name]
    channels = {"time": profile.time, **profile.channels} if profile.time else {}
    if not channels:
        return f"| `{name}` | all | the default names |\n"
    return "".join(
        f"| `{name}` | {channel} | {' or '.join(map(_column, patterns))} |\n"
        for channel, patterns in channels.items()
    )


def _column(pattern: Pattern) -> str:
    return f"`{pattern.column}`{f' in {pattern.unit}' if pattern.unit else ''}"


def _listed(names: tuple[str, ...]) -> str:
    return ", ".join(f"`{name}`" for name in names)


if __name__ == "__main__":
    sys.stdout.write(guide())
