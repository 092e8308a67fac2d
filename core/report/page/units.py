"""Write numbers of joints with the units that they have on a joint of their kind."""

from .words import NOTHING, Document, Number, number


def unit_of_effort(document: Document, joint: int) -> str:
    """Give N for a joint that slides, N m for one that turns."""
    return "N" if _kind(document, joint) == "prismatic" else "N m"


def effort(document: Document, joint: int, value: Number) -> str:
    """Write a torque, or the force of a joint that slides, with its unit."""
    return NOTHING if value is None else f"{number(value)} {unit_of_effort(document, joint)}"


def stray(document: Document, joint: int, value: Number) -> str:
    """Write how far a simulated joint strays (given in rad or m), in thousandths."""
    thousandth = "mm" if _kind(document, joint) == "prismatic" else "mrad"
    return NOTHING if value is None else f"{number(1000.0 * value)} {thousandth}"


def unit_of_mass_matrix(document: Document) -> str:
    """Say in which unit an eigenvalue of the mass matrix is: none of its own where some joints slide."""
    kinds = {one.get("type") for one in document.get("robot", {}).get("joints") or []}
    if "prismatic" not in kinds:
        return "kg m²"
    return "kg" if kinds == {"prismatic"} else "in SI units, of entries in kg m², kg m and kg"


def _kind(document: Document, joint: int) -> str | None:
    listed = document.get("robot", {}).get("joints") or []
    return listed[joint - 1].get("type") if 0 < joint <= len(listed) else None
