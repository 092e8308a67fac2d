"""Show all joints before and after the cure, on held-out data, in torque and in simulated motion."""

from collections.abc import Sequence

from .figures import joint_bars
from .markup import Html, section, table, tag
from .units import effort, stray
from .words import Document, fit_band, interval, is_real, percent


def joints_section(document: Document) -> Html | None:
    """Tabulate every joint before and after on held-out data, in torque and in simulated motion."""
    diagnosis = document["diagnosis"]
    old, new = (_by_joint(diagnosis[side].get("validation") or []) for side in ("before", "after"))
    if not old:
        return None
    parts: list[object] = [_bars(old, new), _compared(document, old, new)] if new else [_alone(document, old)]
    return section("Joint by joint, in torque and in motion", *parts, _motion_table(document))


def _compared(document: Document, old: dict[int, Document], new: dict[int, Document]) -> Html:
    gains = {one["joint"]: one for one in document["diagnosis"].get("gain") or []}
    rows = [
        [
            *_joint(document, row),
            effort(document, joint, row["rms_residual"]),
            effort(document, joint, new[joint]["rms_residual"]),
            percent(row["nrmse_of_rms_percent"]),
            percent(new[joint]["nrmse_of_rms_percent"]),
            *_gain(gains.get(joint)),
            _causes_on(document, joint),
        ]
        for joint, row in old.items()
    ]
    errors = ("torque RMS", "error before", "after", "before, % of RMS", "after")
    headings = ("joint", *errors, "improvement", "95 %", "what was found on it")
    return table(_UNSEEN, headings, rows, note=f"{_TORQUE_NOTE} {_band_note(document)}", text=(8,))


def _alone(document: Document, old: dict[int, Document]) -> Html:
    rows = [
        [
            *_joint(document, row),
            effort(document, joint, row["rms_residual"]),
            percent(row["nrmse_of_rms_percent"]),
            _causes_on(document, joint),
        ]
        for joint, row in old.items()
    ]
    headings = ("joint", "torque RMS", "error", "% of RMS", "what was found on it")
    return table(_UNSEEN, headings, rows, note=_band_note(document), text=(4,))


_UNSEEN = "Error of the predicted torque on data that no fit has seen"
_TORQUE_NOTE = (
    "The interval comes from drawing whole blocks of time anew; an "
    "interval that holds zero means no difference on that joint that is sure."
)


def _band_note(document: Document) -> str:
    return f"Torque and error {fit_band(document)}, the band that the model is fitted in."


def _joint(document: Document, row: Document) -> tuple[str, str]:
    joint = int(row["joint"])
    return str(joint), effort(document, joint, row["rms_torque"])


def _gain(gain: Document | None) -> tuple[object, str]:
    if gain is None:
        return "", ""
    ends = gain["interval_95"]
    return _improvement(gain["improvement_percent"], ends), interval(ends)


def _causes_on(document: Document, joint: int) -> str:
    titles = (one["title"] for one in document["diagnosis"]["findings"] if joint in one["joints"])
    return "; ".join(dict.fromkeys(titles))


def _bars(old: dict[int, Document], new: dict[int, Document]) -> Html:
    before, after = (
        [float(row["nrmse_of_rms_percent"] or 0.0) for row in side.values()] for side in (old, new)
    )
    return joint_bars(
        "Error per joint", before, after, "Error of the predicted torque, % of the torque's RMS, unseen data"
    )


def _motion_table(document: Document) -> Html | None:
    simulation = document["diagnosis"].get("simulation") or {}
    old, new = simulation.get("before") or {}, simulation.get("after") or {}
    if not old:
        told = simulation.get("note")
        return (
            tag("p", f"The motion of both models was not compared: {told}.", class_="note") if told else None
        )
    horizons, number_of_joints = old["horizons_s"], len(old["position_rms"][0])
    ends = simulation.get("interval_95") or [None] * number_of_joints
    headings = [
        "joint",
        *(f"{side} {1000.0 * one:.0f} ms" for one in horizons for side in ("before,", "after,")),
    ]
    rows = [
        [
            f"{joint + 1}",
            *(
                stray(document, joint + 1, side["position_rms"][place][joint])
                for place in range(len(horizons))
                for side in (old, new)
            ),
            _improvement(simulation["improvement_total_percent"][joint], ends[joint]),
            interval(ends[joint]),
        ]
        for joint in range(number_of_joints)
    ]
    told = simulation.get("note")
    note = (
        f"From {old['windows']} measured states in unseen data, both models were driven by the measured "
        "torque; the error is how far the simulated robot had strayed from the measured one, RMS."
        f"{f' In the extended model {told}.' if told else ''}"
    )
    return table("Error of the simulated motion", (*headings, "improvement", "95 %"), rows, note=note)


def _improvement(value: float | None, ends: Sequence[float | None] | None) -> Html:
    kind = "better" if is_real(value, ends) else "worse" if is_real(value, ends, sign=-1.0) else None
    return tag("span", percent(value), class_=kind)


def _by_joint(rows: Sequence[Document]) -> dict[int, Document]:
    return {int(row["joint"]): row for row in rows}
