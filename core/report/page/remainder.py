"""Tell what a diagnosis leaves: what is still predictable and where, and what this motion could not show."""

from .figures import dependence_figure
from .markup import Html, listing, section, table, tag, together
from .units import effort, unit_of_effort
from .words import Document, band, coordinate, interval, joints, number, series, share

_SOURCES = {
    "repeats": "repeats of the motion",
    "high_band": "torque above the motion's band",
    "none": "unknown",
}

_MOSTLY = 0.5
"""Share of a joint's error from which on a sentence is due."""
_WELL_ABOVE = 1.5
"""A noise floor from another band than the residual's is no better known than this factor."""


def unexplained_section(document: Document) -> Html:
    """Tabulate per joint what a generic learner still predicts, beside the noise floor."""
    left = document["diagnosis"]["unexplained"]
    shares = left["predictable_residual_fraction"]
    rows = [
        (
            str(joint + 1),
            effort(document, joint + 1, left["rms_residual"][joint]),
            effort(document, joint + 1, left["noise_floor"][joint]),
            _SOURCES.get(left["noise_floor_source"][joint], left["noise_floor_source"][joint]),
            share(shares[joint]),
            interval([end and 100.0 * end for end in left["interval_95"][joint]]),
            _where(left["places"][joint], joint + 1),
        )
        for joint in range(len(shares))
    ]
    headings = ("joint", "residual RMS", "noise floor", "floor from", "predictable share", "95 %", "where")
    note = (
        f"RMS {band(document)}. Noise floor: the noise, estimated without "
        "any model. Predictable share: how much of the residual's mean square a generic learner foretells, "
        "which is the most that any further cause could explain."
    )
    return section(
        "What stays unexplained",
        *(tag("p", sentence) for sentence in _said(left)),
        table("What is left", headings, rows, note=note, text=(3, 6)),
        dependence_figure(_clearest(document)),
    )


def _said(left: Document) -> list[str]:
    shares, marked = left["predictable_residual_fraction"], left["joints"]
    parked = [joint for joint, one in enumerate(shares, start=1) if one is None]
    others = "any other joint" if parked else "any joint"
    pattern = left["pattern"]
    foretold = [
        joint for joint in marked if pattern is None or joint != pattern["joint"] or shares[joint - 1]
    ]
    told = (
        f"On {series([f'joint {joint} ({share(shares[joint - 1])})' for joint in foretold])} part of the "
        "residual still follows the motion: a cause that is not in the list, or one that this log cannot "
        "separate."
        if foretold
        else "A generic learner, given positions, speeds, loads and time, cannot predict the residual of "
        f"{others} on data it has not seen."
    )
    if pattern:
        told += f" {pattern['statement']}, as no cause in the list would (p = 10^{pattern['log10_p']:.0f})."
    elif not marked:
        told += " Nothing that follows the motion is left: no extension of the model would gain much."
    said = [told]
    if above := _above_the_floor(left):
        said.append(
            f"On {joints(above)} what is left lies well above the noise floor without following the motion: "
            "vibration, or noise that remembers for long and hides structure from the learner."
        )
    if at_rest := _mostly_at_rest(left):
        said.append(
            f"Friction while the joint stands still or turns round makes {series(at_rest)}. At rest it takes "
            "whatever value keeps the joint in place: this is stiction, no dynamics that a model could "
            "foretell, and it was set aside before anything was judged."
        )
    if parked:
        said.append(f"Of {joints(parked)}, which the motion hardly moves, nothing can be said.")
    return said


def _mostly_at_rest(left: Document) -> list[str]:
    return [
        f"{share(one)} of the squared error on joint {joint}"
        for joint, one in enumerate(left["at_rest_fraction"], start=1)
        if one is not None and one > _MOSTLY
    ]


def _above_the_floor(left: Document) -> list[int]:
    pairs = zip(left["rms_residual"], left["noise_floor"], strict=True)
    return [
        joint
        for joint, (rms, floor) in enumerate(pairs, start=1)
        if joint not in left["joints"] and rms is not None and floor is not None and rms > _WELL_ABOVE * floor
    ]


def _clearest(document: Document) -> list[tuple[Document, str]]:
    """Take every joint with structure left over the coordinate that the structure follows most clearly."""
    diagnosis = document["diagnosis"]
    found = []
    for joint in diagnosis["unexplained"]["joints"]:
        listed = [one for one in diagnosis["atlas"] if one["joint"] == joint and one["p_value"] is not None]
        if listed:
            clearest = min(listed, key=lambda one: (one["p_value"], -one["statistic"]))
            found.append((clearest, unit_of_effort(document, joint)))
    return found


def not_shown_section(document: Document) -> Html | None:
    """List the causes that this motion could not have shown, with the motion that would."""
    listed = document["diagnosis"]["not_identifiable"]
    if not listed:
        return None
    reasons = dict.fromkeys(str(one["why"]) for one in listed)
    parts = [
        part
        for why in reasons
        for part in (
            tag("p", f"{why[:1].upper()}{why[1:]}:"),
            listing(_missing(one) for one in listed if one["why"] == why),
        )
    ]
    return section("What this motion could not have shown", *parts)


def _missing(one: Document) -> Html:
    cause = tag("b", f"{one.get('title', one['cause'])}, {joints(one['joints'])}")
    shown = tag("i", "Motion that would show it: ")
    return together([cause, ". ", shown, f"{one['separating_experiment']}."])


def _where(places: list[Document], joint: int) -> str:
    if not places:
        return ""
    place = places[0]
    name = coordinate(place["coordinate"], joint)
    return f"{name} from {number(place['low'])} to {number(place['high'])} {place['unit']}"
