"""Play one joint, rigid or flexible, under its controller through the samples of a log, compiled.

Between samples the torque is held, and the linear part of the motion is exact. Friction of the motor takes
what brings the motor to rest at the next sample, up to its level (Moreau's time-stepping). Sources: as for
`loop_kernel`.
"""

# ruff: noqa: ANN001, PLR0913, PLR0917  # numba: types stand in signatures, tables come singly
# Types stand in numba's signatures, which mypy does not read:
# mypy: disable-error-code="no-untyped-def"

import numpy as np
from numba import njit

from ..integrate import FASTEST
from ..kernel import OPTIONS, TABLE
from .loop_kernel import BEFORE, EARLIER, FILTERED, POSITION, STATE_ROWS, command

POSITION_COLUMN, TORQUE_COLUMN, SHARE_COLUMN, LINK_COLUMN = range(4)
COLUMNS = 4


@njit(
    f"int64({TABLE}, {TABLE}, float64[::1], {TABLE}, UniTuple({TABLE}, 3), float64[::1], float64, {TABLE})",
    **OPTIONS,
)
def play_joint(  # pragma: no cover  (compiled)
    transition, gains, loads, law, inputs, state, step, played
) -> int:
    """Step through all samples; gives the sample at which the motion fails, or -1.

    Parameters
    ----------
    transition
        The states after a step of those before: motor position and speed, and of a flexible joint the link's.
    gains
        Two rows: what a torque on the motor, and one on the link, held for a step adds to the states.
    loads
        Coulomb friction and offset of the motor, and the factors of sine and cosine of the link's position.
    law, inputs
        The controller of one joint, and its feed-forward torque, position and velocity wanted per sample.
    state
        Where the joint begins.
    step
        Time between samples, s.
    played
        What is written per sample: motor position, torque, friction as a share of its level, link position.
    """
    size = len(transition)
    link = size - 2
    x, after = state.copy(), np.zeros(size)
    table, out, ahead, implicit = np.zeros((STATE_ROWS, 1)), np.zeros((1, 1)), np.zeros((1, 1)), np.zeros(1)
    table[EARLIER, 0], table[BEFORE, 0], table[FILTERED, 0] = (
        x[0] - step * x[1],
        x[0] - 2.0 * step * x[1],
        x[1],
    )
    for k in range(len(played)):
        table[POSITION, 0], ahead[0, 0] = x[0], x[1]
        command(out, implicit, law, table, ahead, inputs[0], inputs[1], inputs[2], k, step)
        torque = out[0, 0] - implicit[0] * x[1]
        pull = loads[2] * np.sin(x[link]) + loads[3] * np.cos(x[link])
        for i in range(size):
            after[i] = gains[0, i] * (torque - loads[1]) - gains[1, i] * pull
            for j in range(size):
                after[i] += transition[i, j] * x[j]
        held = after[1] / gains[0, 1]
        share = np.sign(held)
        if loads[0] > 0.0:
            held = min(max(held, -loads[0]), loads[0])
            share = held / loads[0]
        else:
            held = 0.0
        played[k, 0], played[k, 1], played[k, 2], played[k, 3] = x[0], torque, share, x[link]
        for i in range(size):
            x[i] = after[i] - gains[0, i] * held
        if not abs(x[1]) <= FASTEST:
            return k
    return -1
