"""Ask about measured robots, whose public logs are kept beside the project; without them nothing is asked."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from tests.answers.product import Document, IdentifyRequest, diagnose, identify
from tests.measured import FRANKA_ROWS, TX40_TEST, TX40_TRAIN, measured_log, measured_robot

FEW: Document = {"bootstrap": {"draws": 0}}
LAST_HELD_OUT: Document = {"validation": {"logs": [2]}}
HALF = FRANKA_ROWS // 2
TX40 = (("run1", *TX40_TRAIN), ("run1", *TX40_TEST))
UR10E = (("fourier_30s_12h", 635, 3510), ("fourier_20s_8h", 320, 2310), ("fourier_40s_12h", 500, 4460))
POINTS = (UR10E[0], ("validation_ptp_10pts", 700, 4200))
PANDA = (("traj1", 0, HALF), ("traj1", HALF, FRANKA_ROWS))
ROKAE = (("excit",),)


def asks() -> Mapping[str, Callable[[], Document]]:
    """List what is asked, by name; the TX40 once with the coupling of its wrist and once without."""
    plain = partial(_asked, "staubli_tx40", TX40, coupled=False)
    return {
        "tx40-diagnose": partial(plain, diagnose, FEW),
        "tx40-identify": partial(_asked, "staubli_tx40", TX40, identify, LAST_HELD_OUT),
        "tx40-identify-smooth": partial(
            _asked, "staubli_tx40", TX40, identify, FEW | {"smooth_coulomb": True}
        ),
        "tx40-identify-uncoupled": partial(plain, identify, FEW),
        "tx40-diagnose-coupled": partial(_asked, "staubli_tx40", TX40, diagnose, FEW | LAST_HELD_OUT),
        "ur10e-diagnose": partial(_asked, "ur10e_open", UR10E, diagnose, FEW | {"validation": {"logs": [3]}}),
        "ur10e-identify": partial(_asked, "ur10e_open", UR10E, identify, {"validation": {"logs": [3]}}),
        "ur10e-diagnose-points": partial(_asked, "ur10e_open", POINTS, diagnose, FEW | LAST_HELD_OUT),
        "ur10e-identify-points": partial(_asked, "ur10e_open", POINTS, identify, {"smooth_coulomb": True}),
        "panda-diagnose": partial(_asked, "franka_panda", PANDA, diagnose, FEW | LAST_HELD_OUT),
        "panda-identify": partial(_asked, "franka_panda", PANDA, identify, LAST_HELD_OUT),
        "rokae-diagnose": partial(_asked, "rokae_xmate3", ROKAE, diagnose, FEW),
        "rokae-identify": partial(_asked, "rokae_xmate3", ROKAE, identify, {}),
    }


def _asked(
    robot: str,
    runs: tuple[tuple[Any, ...], ...],
    task: Callable[[Any], Document],
    options: Document,
    *,
    coupled: bool = True,
) -> Document:
    logs = tuple(measured_log(robot, *run) for run in runs)
    return task(IdentifyRequest(measured_robot(robot, coupled=coupled), logs, options))
