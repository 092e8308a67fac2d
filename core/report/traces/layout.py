"""Name the columns of the file of traces: one row per decimated sample, one column per signal and joint.

The names are those of the published file `residuals.parquet`; what a reader asks for is named without the
joint's number.
"""

LOG, TIME, HELD_OUT, USED, REVERSAL = "log", "time", "held_out", "used", "reversal"
MEASURED = ("position", "velocity", "torque_measured", "torque_filtered")
PREDICTED = ("torque_estimated", "residual")
EXTENDED = ("torque_estimated_after", "residual_after")
"""Of the model that a diagnosis extended."""
SIGNALS = (*MEASURED, *PREDICTED, *EXTENDED)


def column(signal: str, joint: int) -> str:
    """Name the column of a signal of a joint, counted from 1.

    Examples
    --------
    >>> column("residual", 3)
    'residual_3'
    """
    return f"{signal}_{joint}"


def unit(signal: str, kind: str) -> str:
    """Give the unit of a signal on a revolute or a prismatic joint.

    Examples
    --------
    >>> unit("velocity", "revolute"), unit("residual", "prismatic")
    ('rad/s', 'N')
    """
    turns = kind == "revolute"
    if signal == "position":
        return "rad" if turns else "m"
    if signal == "velocity":
        return "rad/s" if turns else "m/s"
    return "N m" if turns else "N"
