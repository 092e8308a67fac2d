"""Take an identified robot to MuJoCo and let it swing: gravity, friction and rotor inertias are in the file.

Needs mujoco (``pip install mujoco``) and a `result.json`, which 01_identify writes. Run
``python -m examples.06_mujoco``.
"""

import json
from pathlib import Path

import mujoco
import numpy as np

from veritorque.core.export.formats import FORMATS

SECONDS = 2.0


def main() -> None:
    """Export, load, let go, look."""
    result = json.loads(Path("result.json").read_text(encoding="utf-8"))
    Path("robot.xml").write_bytes(FORMATS["robot.xml"].write(result))

    model = mujoco.MjModel.from_xml_path("robot.xml")
    data = mujoco.MjData(model)
    while data.time < SECONDS:
        mujoco.mj_step(model, data)

    print(f"{model.nv} joints, {model.body_mass.sum():.1f} kg")
    print(f"after {SECONDS:.0f} s without torque:")
    for joint, position in enumerate(np.degrees(data.qpos), start=1):
        print(f"joint {joint}: {position:7.1f} deg, {np.degrees(data.qvel[joint - 1]):6.1f} deg/s")


if __name__ == "__main__":
    main()
