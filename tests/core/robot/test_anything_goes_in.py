"""Whatever is sent as a robot, the answer is a robot or a `RobotError`: nothing foreign leaks."""

import copy

from hypothesis import example, given, settings
from hypothesis import strategies as st

from tests.core.robot.urdf.makers import joint, link, robot
from veritorque.core.errors import RobotError
from veritorque.core.robot.builtin import builtin_description
from veritorque.core.robot.description import robot_from_description
from veritorque.core.robot.model import RobotModel
from veritorque.core.robot.urdf.read import robot_from_urdf
from veritorque.core.robot.writing import to_description

JUNK = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=6,
)
WHOLE = builtin_description("yumi-left") | {
    "couplings": [{"name": "motor", "number": 7, "joints": [6, 7], "weights": [1.0, 1.0]}],
    "prior": [
        {"mass": 1.0, "center_of_mass": [0.0, 0.0, 0.1], "inertia_at_com": [1.0, 0.0, 0.0, 1.0, 0.0, 1.0]}
    ]
    * 7,
}
URDF = robot(link("base") + link("tip") + joint("a", "revolute", "base", "tip", '<mimic joint="a"/>'))


def _places(value: object, path: tuple = ()) -> list[tuple]:
    """List the paths to everything inside a document."""
    inside = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [path, *(place for key, one in inside for place in _places(one, (*path, key)))]


def _with(value: object, path: tuple, new: object) -> object:
    if not path:
        return new
    changed = copy.copy(value)
    changed[path[0]] = _with(value[path[0]], path[1:], new)
    return changed


def _is_answered(read, document: object) -> None:
    try:
        answer = read(document)
    except RobotError as error:
        told = (bool(error.cause), bool(error.evidence), bool(error.remedy))
    else:
        told = (isinstance(answer, RobotModel), bool(to_description(answer)), True)
    assert told == (True, True, True)


@settings(max_examples=300)
@given(st.sampled_from(_places(WHOLE)), JUNK)
@example((), {})
@example(("couplings", 0, "weights"), [1.0])
@example(("joints", 0, "friction"), [[]])
@example(("joints", 0, "type"), [])
@example(("convention",), {})
@example(("prior", 0, "center_of_mass", 1), 1e200)
@example(("prior", 0, "mass"), 1e30)
def test_a_description_with_anything_anywhere_is_a_robot_or_a_robot_error(place, junk):
    _is_answered(robot_from_description, _with(WHOLE, place, junk))


@settings(max_examples=300)
@given(st.integers(0, len(URDF)), st.integers(0, 30), st.text(max_size=10) | st.binary(max_size=10))
@example(0, 0, "\ud800")
def test_a_urdf_with_anything_anywhere_is_a_robot_or_a_robot_error(start, length, junk):
    before, after = URDF[:start], URDF[start + length :]
    text = before + junk + after if isinstance(junk, str) else before.encode() + junk + after.encode()
    _is_answered(robot_from_urdf, text)
