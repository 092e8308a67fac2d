"""Gather columns that belong together: one quantity of all joints, by what their names have in common.

Most recorders number the joints, others name them. What is left of a name without the joint tells the
quantity, and the arm where there are several.
"""

import re
from collections.abc import Callable, Collection, Hashable, Mapping, Sequence
from itertools import chain

from ..channels import CHANNELS, JOINT_CHANNELS, REFERENCE_WORDS, TIME
from .named_units import unit_in_name

_CHANNEL_WORDS = frozenset(word for channel in JOINT_CHANNELS for word in channel.words) - {"joint", "joints"}
_CLOCK_WORDS = frozenset(CHANNELS[TIME].words)
_COUNTER_WORDS = frozenset(("index", "idx", "count", "counter", "number", "nr", "no", "id"))
"""Words by which a name tells that it counts rows, whatever else it says."""
MOTOR = "motor"
"""Word of what is on the motor's side of a gear."""
_MEASURED_WORDS = frozenset(("actual", "measured", "act", "meas", "msr", "ist", "feedback", "fbk"))
_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+")
_BRACKETS = re.compile(r"[\[({<][^\[\](){}<>]*[A-Za-z%°][^\[\](){}<>]*[\])}>]")
_INDEX = re.compile(r"\d+")
_GERMAN = {
    "zeit": "time",
    "zeitstempel": "timestamp",
    "lage": "position",
    "winkel": "angle",
    "weg": "position",
    "hub": "position",
    "geschwindigkeit": "velocity",
    "drehzahl": "speed",
    "drehmoment": "torque",
    "kraft": "force",
    "strom": "current",
    "temperatur": "temperature",
    "soll": "ref",
}
"""German words of controllers' exports, and the English ones that tell the same channel."""
_GERMAN_FIRST = re.compile(r"(ist|soll|motor)([a-z]{4,})")
"""First part of a German compound: actual, asked for, of the motor."""


_ALONG = (
    "base", "waist", "torso", "shoulder", "upper", "upperarm", "elbow", "lower", "lowerarm", "forearm",
    "wrist", "hand", "flange", "tool", "gripper", "finger",
)  # fmt: skip  # a table
"""Parts of an arm from its base on, by which its joints are called."""
_BEFORE = ("pan", "yaw", "lift", "pitch", "flex")
"""Of two joints of one part, the one about the vertical comes first."""


def name_words(name: str) -> set[str]:
    """Cut a name at its signs, numbers and capitals; what stands in brackets is a unit and no word of it.

    Examples
    --------
    >>> sorted(name_words("Joint1_Pos [deg]"))
    ['joint', 'pos']
    >>> sorted(name_words("Sollwinkel_A1")), sorted(name_words("Motorstrom 1"))
    (['a', 'angle', 'ref'], ['current', 'motor'])
    """
    words = (word.lower() for word in _WORD.findall(_BRACKETS.sub(" ", name)))
    parts = (part for word in words for part in _parts(word))
    return {_GERMAN.get(part, part) for part in parts}


def _parts(word: str) -> tuple[str, ...]:
    """Part a German compound that tells what is asked for or measured."""
    compound = _GERMAN_FIRST.fullmatch(word)
    return (word,) if compound is None else compound.groups()


def numbered_families(names: Sequence[str]) -> dict[str, list[str]]:
    """Gather columns that differ in their last number only, in the order of that number.

    A joint of another kind has another unit, and another word for the same channel: brackets and such words
    may differ as well where no number occurs twice.

    Examples
    --------
    >>> numbered_families(["A1 Moment", "A2 Moment", "A3 Kraft"])
    {'A  Moment': ['A1 Moment', 'A2 Moment', 'A3 Kraft']}
    >>> numbered_families(["t", "q2", "q1"]), numbered_families(["q1 [deg]", "q2 [mm]"])
    ({'q ': ['q1', 'q2']}, {'q': ['q1 [deg]', 'q2 [mm]']})
    """
    families: dict[str, list[tuple[int, str]]] = {}
    for name in names:
        numbers = list(_INDEX.finditer(_BRACKETS.sub(lambda found: " " * len(found[0]), name)))
        if numbers:
            last = numbers[-1]
            stem = f"{name[: last.start()]} {name[last.end() :]}"
            families.setdefault(stem, []).append((int(last.group()), name))
    merged = _merged(_merged(families, _without_unit), _quantity)
    return {stem: [name for _, name in sorted(found)] for stem, found in merged.items()}


def _merged(
    families: Mapping[str, list[tuple[int, str]]], named_by: Callable[[str], Hashable]
) -> dict[str, list[tuple[int, str]]]:
    """Merge families of which the same is said, if they are of different joints."""
    alike: dict[Hashable, list[str]] = {}
    for stem in families:
        alike.setdefault(named_by(stem), []).append(stem)
    merged: dict[str, list[tuple[int, str]]] = {}
    for stems in alike.values():
        found = list(chain.from_iterable(families[stem] for stem in stems))
        is_one = len(stems) > 1 and len({number for number, _ in found}) == len(found)
        largest = max(stems, key=lambda stem: len(families[stem]))
        merged |= {_without_unit(largest): found} if is_one else {stem: families[stem] for stem in stems}
    return merged


def _without_unit(stem: str) -> str:
    return _BRACKETS.sub(" ", stem).strip()


def _quantity(stem: str) -> Hashable:
    """Give channel and arm of a name; the name where it tells no channel."""
    channel, reference = channel_of(stem, ()), name_words(stem) & REFERENCE_WORDS
    return stem if channel is None else (channel, arm_of(stem), frozenset(reference))


def named_families(names: Sequence[str]) -> dict[str, list[str]]:
    """Gather columns that say the same quantity of joints which have names, in the order of the file.

    Examples
    --------
    >>> named_families(["t", "elbow_pos", "wrist_pos", "elbow_eff"])
    {'pos': ['elbow_pos', 'wrist_pos'], 'eff': ['elbow_eff']}
    """
    families: dict[str, list[str]] = {}
    for name in names:
        words = name_words(name)
        named = sorted(words & (_CHANNEL_WORDS | REFERENCE_WORDS))
        if named and words - set(named):
            families.setdefault(" ".join(named), []).append(name)
    return families


def tells_a_part(stem: str) -> bool:
    """Tell whether a name calls a joint by its part of the arm, such as its wrist.

    Examples
    --------
    >>> tells_a_part("position.wrist_ _joint"), tells_a_part("arm pos ")
    (True, False)
    """
    return not name_words(stem).isdisjoint(_ALONG)


def along_arm(names: Sequence[str]) -> list[str]:
    """Put names in the order of an arm from its base on, where all tell a part of it; else as they come.

    Recorders often write joints in the order of the alphabet.

    Examples
    --------
    >>> along_arm(["elbow_pos", "shoulder_lift_pos", "shoulder_pan_pos", "wrist_2_pos", "wrist_1_pos"])
    ['shoulder_pan_pos', 'shoulder_lift_pos', 'elbow_pos', 'wrist_1_pos', 'wrist_2_pos']
    """
    if not all(map(tells_a_part, names)):
        return list(names)
    return sorted(names, key=_place)


def _place(name: str) -> tuple[int, int, int]:
    words, numbers = name_words(name), _INDEX.findall(name)
    part = next(place for place, word in enumerate(_ALONG) if word in words)
    way = next((place for place, word in enumerate(_BEFORE) if word in words), len(_BEFORE))
    return part, way, int(numbers[-1]) if numbers else 0


def single_families(names: Sequence[str]) -> dict[str, list[str]]:
    """Give the columns of one joint, which need no number; empty where two tell the same channel.

    Examples
    --------
    >>> single_families(["t", "angle", "torque"])
    {'angle': ['angle'], 'torque': ['torque']}
    """
    named = {name: channel for name in names if (channel := channel_of(name, ())) is not None}
    unclear = len(set(named.values())) < len(named)
    return {} if unclear else {name: [name] for name in named}


def clocks(names: Sequence[str]) -> list[str]:
    """Give the names that tell a clock, and no count of rows.

    Examples
    --------
    >>> clocks(["time_index", "stamp [ms]", "q_1"])
    ['stamp [ms]']
    """
    told = [name for name in names if name_words(name) & _CLOCK_WORDS and channel_of(name, ()) is None]
    return [name for name in told if not name_words(name) & _COUNTER_WORDS]


def by_plainness(stem: str) -> tuple[bool, bool, int]:
    """Sort names of one channel: measured before asked for, the joint before the motor, few words first.

    Examples
    --------
    >>> sorted(["target_q_", "motor_q_", "q_d_", "q_"], key=by_plainness)
    ['q_', 'q_d_', 'motor_q_', 'target_q_']
    """
    words = name_words(stem)
    return bool(words & REFERENCE_WORDS), MOTOR in words, len(words - _MEASURED_WORDS)


def arm_of(stem: str) -> frozenset[str]:
    """Give the words of a name that are neither a quantity's nor a reference's: those of an arm, if any.

    Examples
    --------
    >>> arm_of("left_q ")
    frozenset({'left'})
    """
    return frozenset(
        name_words(stem) - _CHANNEL_WORDS - REFERENCE_WORDS - {"joint", "joints", MOTOR} - _MEASURED_WORDS
    )


def channel_by_unit(stem: str) -> str | None:
    """Find the channel that alone is measured in the unit which stands in brackets behind a name.

    Examples
    --------
    >>> channel_by_unit("jnt (rad)"), channel_by_unit("load [%]"), channel_by_unit("jnt_rad")
    ('position', None, None)
    """
    if not _BRACKETS.search(stem):
        return None
    measured = (channel.name for channel in JOINT_CHANNELS if channel.need != "reference")
    found = [name for name in measured if unit_in_name(name, stem) is not None]
    return found[0] if len(found) == 1 else None


def channel_of(stem: str, known: Collection[str]) -> str | None:
    """Find the channel of a name; a reference stands for what was measured where nothing else does."""
    words = name_words(stem)
    by_trust = sorted(JOINT_CHANNELS, key=lambda channel: channel.name == "position")  # "joint" says least
    own = list(filter(lambda channel: not words.isdisjoint(channel.words), by_trust))
    measured = next((channel for channel in own if channel.need != "reference"), None)
    if measured is None:
        return own[0].name if own else None
    if not words & REFERENCE_WORDS or (measured.need != "optional" and measured.name not in known):
        return measured.name
    return next((channel.name for channel in JOINT_CHANNELS if channel.reference_to == measured.name), None)
