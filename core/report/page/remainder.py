"""Describe the unexplained residual of a diagnosis, and the causes that are not identifiable."""

from .render import Table
from .units import effort, unit_of_effort
from .words import Document, band, coordinate, interval, joints, number, series, share

_SOURCES = {
    "repeats": "repeats of the motion",
    "high_band": "torque above the bandwidth of the motion",
    "none": "unknown",
}
_MOSTLY = 0.5
"""Share of a joint's squared error from which stiction is mentioned."""
_WELL_ABOVE = 1.5
"""Ratio to the noise floor that counts as above it; the floor is known within this factor."""


def residuals(document: Document) -> Table:
    """Tabulate residual, noise floor and explainable variance per joint."""
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
            _range(left["places"][joint], joint + 1),
        )
        for joint in range(len(shares))
    ]
    headings = (
        "joint",
        "residual RMS",
        "noise floor",
        "source of the floor",
        "explainable variance",
        "95 %",
        "mainly at",
    )
    note = (
        f"RMS {band(document)}. Noise floor: estimated without a model. Explainable variance (R2, upper "
        "bound): share of the mean-square residual that a generic learner predicts on held-out data; no "
        "further cause can explain more."
    )
    return Table("Residual per joint", headings, rows, note, (3, 6))


def sentences(document: Document) -> list[str]:
    """Interpret the unexplained residual in sentences."""
    left = document["diagnosis"]["unexplained"]
    shares, pattern = left["predictable_residual_fraction"], left["pattern"]
    parked = [joint for joint, fraction in enumerate(shares, start=1) if fraction is None]
    listed = [_on_prediction(left)]
    if pattern:
        listed[0] += f" {pattern['statement']}; no known cause explains it (p = 10^{pattern['log10_p']:.0f})."
    elif not left["joints"]:
        listed[0] += " No extension of the model would give a significant improvement."
    if above := _joints_above_floor(left):
        listed.append(
            f"On {joints(above)} the residual is well above the noise floor without depending on the motion: "
            "vibration, or noise with long autocorrelation, which hides structure from the learner."
        )
    if stiction := _mostly_stiction(left):
        listed.append(
            f"Stiction at standstill and at reversals causes {series(stiction)}. It was excluded from the "
            "diagnosis: friction at rest balances the other torques and is not a function of the motion."
        )
    if parked:
        listed.append(f"No statement is possible on {joints(parked)}: there is hardly any motion.")
    return listed


def _on_prediction(left: Document) -> str:
    """Say on which joints a learner predicts the residual, or that it does on none."""
    shares, of_pattern = left["predictable_residual_fraction"], (left["pattern"] or {}).get("joint")
    predicted = [joint for joint in left["joints"] if joint != of_pattern or shares[joint - 1]]
    if not predicted:
        return (
            "A generic learner with positions, velocities, loads and time as inputs cannot predict the "
            f"residual of {'any other joint' if None in shares else 'any joint'} on held-out data."
        )
    return (
        f"On {series([f'joint {joint} ({share(shares[joint - 1])})' for joint in predicted])} part of the "
        "residual depends on the motion: an unknown cause, or one that is not identifiable from this log."
    )


def _mostly_stiction(left: Document) -> list[str]:
    return [
        f"{share(fraction)} of the squared error on joint {joint}"
        for joint, fraction in enumerate(left["at_rest_fraction"], start=1)
        if fraction is not None and fraction > _MOSTLY
    ]


def _joints_above_floor(left: Document) -> list[int]:
    pairs = zip(left["rms_residual"], left["noise_floor"], strict=True)
    return [
        joint
        for joint, (rms, floor) in enumerate(pairs, start=1)
        if joint not in left["joints"] and rms is not None and floor is not None and rms > _WELL_ABOVE * floor
    ]


def clearest_dependences(document: Document) -> list[tuple[Document, str]]:
    """Select the most significant coordinate of every joint with structure, with the unit of its torque."""
    diagnosis = document["diagnosis"]
    found = []
    for joint in diagnosis["unexplained"]["joints"]:
        listed = [row for row in diagnosis["atlas"] if row["joint"] == joint and row["p_value"] is not None]
        if listed:
            clearest = min(listed, key=lambda row: (row["p_value"], -row["statistic"]))
            found.append((clearest, unit_of_effort(document, joint)))
    return found


def not_identifiable(document: Document) -> list[tuple[str, list[Document]]]:
    """Group the causes that are not identifiable by reason."""
    listed = document["diagnosis"]["not_identifiable"]
    reasons = dict.fromkeys(str(cause["why"]) for cause in listed)
    return [
        (f"{why[:1].upper()}{why[1:]}", [cause for cause in listed if cause["why"] == why]) for why in reasons
    ]


def _range(places: list[Document], joint: int) -> str:
    if not places:
        return ""
    place = places[0]
    name = coordinate(place["coordinate"], joint)
    return f"{name} from {number(place['low'])} to {number(place['high'])} {place['unit']}"
