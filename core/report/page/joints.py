"""Compare all joints before and after the correction on held-out data, in torque and in simulated motion."""

from collections.abc import Sequence
from itertools import product

from markupsafe import Markup

from .figures import joint_bars
from .render import Table, element
from .units import effort, position_error
from .words import Document, fit_band, interval, is_significant, percent

_CAPTION = "Torque prediction error on held-out data"
_FINDINGS = "findings on the joint"
_INTERVAL_NOTE = (
    "The 95 % interval is from a block bootstrap. If it contains zero, the improvement on that joint is not "
    "significant."
)


def joint_errors(document: Document) -> dict[str, object]:
    """Give tables and bars of the errors of all joints, in torque and in simulated motion."""
    diagnosis = document["diagnosis"]
    old, new = (_by_joint(diagnosis[side].get("validation") or []) for side in ("before", "after"))
    compared = bool(old and new)
    return {
        "errors": _comparison_table(document, old, new) if compared else _single_table(document, old),
        "error_bars": _bars(old, new) if compared else None,
        "motion": _motion(document),
        "motion_note": (diagnosis.get("simulation") or {}).get("note"),
    }


def _comparison_table(document: Document, old: dict[int, Document], new: dict[int, Document]) -> Table:
    gains = {gain["joint"]: gain for gain in document["diagnosis"].get("gain") or []}
    rows = [
        [
            *_joint(document, row),
            effort(document, joint, row["rms_residual"]),
            effort(document, joint, new[joint]["rms_residual"]),
            percent(row["nrmse_of_rms_percent"]),
            percent(new[joint]["nrmse_of_rms_percent"]),
            *_gain(gains.get(joint)),
            _titles_on(document, joint),
        ]
        for joint, row in old.items()
    ]
    errors = ("RMS torque", "error before", "after", "before, % of RMS", "after")
    headings = ("joint", *errors, "improvement", "95 %", _FINDINGS)
    return Table(_CAPTION, headings, rows, f"{_INTERVAL_NOTE} {_band_note(document)}", (8,))


def _single_table(document: Document, scores: dict[int, Document]) -> Table:
    rows = [
        [
            *_joint(document, row),
            effort(document, joint, row["rms_residual"]),
            percent(row["nrmse_of_rms_percent"]),
            _titles_on(document, joint),
        ]
        for joint, row in scores.items()
    ]
    headings = ("joint", "RMS torque", "error", "% of RMS", _FINDINGS)
    return Table(_CAPTION, headings, rows, _band_note(document), (4,))


def _band_note(document: Document) -> str:
    return f"Torque and error {fit_band(document)}, the bandwidth of the fit."


def _joint(document: Document, row: Document) -> tuple[str, str]:
    joint = int(row["joint"])
    return str(joint), effort(document, joint, row["rms_torque"])


def _gain(gain: Document | None) -> tuple[object, str]:
    if gain is None:
        return "", ""
    ends = gain["interval_95"]
    return _improvement(gain["improvement_percent"], ends), interval(ends)


def _titles_on(document: Document, joint: int) -> str:
    findings = document["diagnosis"]["findings"]
    return "; ".join(dict.fromkeys(finding["title"] for finding in findings if joint in finding["joints"]))


def _bars(old: dict[int, Document], new: dict[int, Document]) -> Markup:
    """Draw the joints of which there is an error: one that never moves has none."""
    errors = [(joint, *(side[joint]["nrmse_of_rms_percent"] for side in (old, new))) for joint in old]
    known = [own for own in errors if None not in own]
    return joint_bars("Error per joint", known, f"{_CAPTION}, % of RMS torque")


def _motion(document: Document) -> Table | None:
    simulation = document["diagnosis"].get("simulation") or {}
    old, new = simulation.get("before"), simulation.get("after")
    if not old:
        return None
    horizons, joints = old["horizons_s"], range(len(old["position_rms"][0]))
    ends = simulation.get("interval_95") or [None] * len(joints)
    times = [f"{side}, {1000.0 * time:.0f} ms" for time, side in product(horizons, ("before", "after"))]
    rows = [
        [
            f"{joint + 1}",
            *(
                position_error(document, joint + 1, side["position_rms"][index][joint])
                for index, side in product(range(len(horizons)), (old, new))
            ),
            _improvement(simulation["improvement_total_percent"][joint], ends[joint]),
            interval(ends[joint]),
        ]
        for joint in joints
    ]
    note = (
        f"Both models are simulated from {old['windows']} measured states in held-out data, driven by the "
        "measured torque. Error: RMS difference between simulated and measured position."
    )
    if remark := simulation.get("note"):
        note += f" Extended model: {remark}."
    return Table("Error of the simulated motion", ("joint", *times, "improvement", "95 %"), rows, note)


def _improvement(value: float | None, ends: Sequence[float | None] | None) -> Markup:
    if is_significant(value, ends):
        return element("span", percent(value), class_="better")
    worse = {"class_": "worse"} if is_significant(value, ends, sign=-1.0) else {}
    return element("span", percent(value), **worse)


def _by_joint(rows: Sequence[Document]) -> dict[int, Document]:
    return {int(row["joint"]): row for row in rows}
