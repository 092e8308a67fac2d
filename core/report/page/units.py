"""Write numbers of joints in the units of their joint type."""

from .words import NOTHING, Document, Number, number


def unit_of_effort(document: Document, joint: int) -> str:
    """Give N for a prismatic joint, N m for a revolute one."""
    return "N" if _kind(document, joint) == "prismatic" else "N m"


def effort(document: Document, joint: int, value: Number) -> str:
    """Write a torque (prismatic: force) with its unit."""
    return NOTHING if value is None else f"{number(value)} {unit_of_effort(document, joint)}"


def position_error(document: Document, joint: int, value: Number) -> str:
    """Write a position error (rad or m) in mrad or mm."""
    thousandth = "mm" if _kind(document, joint) == "prismatic" else "mrad"
    return NOTHING if value is None else f"{number(1000.0 * value)} {thousandth}"


def unit_of_mass_matrix(document: Document) -> str:
    """Give the unit of an eigenvalue of the mass matrix; with mixed joint types it has none of its own."""
    kinds = {joint.get("type") for joint in document.get("robot", {}).get("joints") or []}
    if "prismatic" not in kinds:
        return "kg m²"
    return "kg" if kinds == {"prismatic"} else "in SI units, with entries in kg m², kg m and kg"


def _kind(document: Document, joint: int) -> str | None:
    listed = document.get("robot", {}).get("joints") or []
    return listed[joint - 1].get("type") if 0 < joint <= len(listed) else None
