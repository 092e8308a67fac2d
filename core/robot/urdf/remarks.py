"""Say what a URDF holds that is read otherwise than written, left out, or probably not meant.

Only the chosen part is judged, and of its fixed joints only those that carry something that moves.
"""

from collections.abc import Iterable

from ..plausibility import angle_remarks
from .document import UrdfDocument, UrdfJoint
from .part import Part

_NAMED = 8
"""How many joints a sentence names before it counts the rest."""


def urdf_remarks(document: UrdfDocument, part: Part) -> tuple[str, ...]:
    """List remarks, in sentences with numbers."""
    moving = [joint for joint, moves in part if moves]
    found = [] if document.name else ["the URDF gives the robot an empty name"]
    angles = {
        f"joint {joint.name}: {name}": float(angle)
        for joint in _that_place(part)
        for name, angle in zip(("roll", "pitch", "yaw"), joint.angles, strict=True)
    }
    found += angle_remarks(angles) + _about_limits(moving)
    declared = [joint.name for joint in moving if joint.has_dynamics]
    if declared:
        found.append(
            f"damping and friction of {_named(declared)} (the element dynamics) are not used: they are "
            "identified from the log"
        )
    return tuple(found)


def _that_place(part: Part) -> list[UrdfJoint]:
    """List the joints on whose angles the place of a moving link depends."""
    above = {joint.child: joint for joint, _ in part}
    wanted: dict[str, UrdfJoint] = {}
    for joint, moves in part:
        step: UrdfJoint | None = joint if moves else None
        while step is not None and step.name not in wanted:
            wanted[step.name] = step
            step = above.get(step.parent)
    return [joint for joint, _ in part if joint.name in wanted]


def _about_limits(moving: Iterable[UrdfJoint]) -> list[str]:
    return [
        f"joint {joint.name}: its lower limit {joint.stops[0]:.4g} lies above the upper one "
        f"{joint.stops[1]:.4g}, which some writers mean as none: it is taken to have no limit"
        for joint in moving
        if joint.stops[0] > joint.stops[1]
    ]


def _named(names: list[str]) -> str:
    shown = ", ".join(names[:_NAMED]) + (f" and {len(names) - _NAMED} more" if len(names) > _NAMED else "")
    return f"joint{'s' if len(names) > 1 else ''} {shown}"
