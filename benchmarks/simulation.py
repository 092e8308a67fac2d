"""YuMi's 7-joint arm simulated over many windows at once, against a Python loop over pinocchio's aba.

Both sides take the same steps of Heun's scheme with the same drives (rotor inertia, viscous friction) and the
same sampled torque, and write every position and velocity down. Ours takes the friction implicitly, which
shows in the difference; it ends at the same motion as the steps get shorter. Beside them the compiled loop
plays one long motion with dry friction and a joint controller, sample after sample.
"""

from typing import Any

import numpy as np
import pinocchio as pin

from benchmarks.figures import Figure, processor_seconds
from benchmarks.peer import pinocchio_model
from benchmarks.scene import smooth_motion, yumi_arm
from veritorque.core.dynamics.model import standard_model
from veritorque.core.robot.inertia import mass_properties
from veritorque.core.signals.state import MotionState
from veritorque.core.simulation.closed_loop.loop import Loop
from veritorque.core.simulation.closed_loop.replay import default_gains
from veritorque.core.simulation.control.control_law import ControlLaw, Inputs
from veritorque.core.simulation.drive import Drive
from veritorque.core.simulation.mechanism import Mechanism, mechanism_of
from veritorque.core.simulation.rollout import rollout
from veritorque.core.simulation.stage import States

STEP = 1e-3
STEPS = 200
"""A window of 200 ms at 1 kHz."""
WINDOWS = 1500


def run(*, quick: bool) -> list[Figure]:
    """Time both on the same windows, and compare where they end."""
    windows, repeats = (64, 1) if quick else (WINDOWS, 7)
    mechanism = smooth_arm()
    start, torque = windows_of(mechanism, windows)
    few = min(windows, 8)
    model = peer(mechanism)
    states = States.starting(mechanism, start)
    drive = Drive(STEP, torque)
    loop = processor_seconds(lambda: looped(model, mechanism, start, torque, few), repeats=repeats)
    ours = processor_seconds(lambda: rollout(mechanism, states, drive), repeats=repeats)
    again = processor_seconds(lambda: looped(model, mechanism, start, torque, few), repeats=repeats)
    step = ours / (STEPS * windows) * 1e6
    theirs = 0.5 * (loop + again) / (STEPS * few) * 1e6
    gap = difference(mechanism, start, torque, few)
    return [
        Figure("simulated step, us", f"{step:.3f}", "", f"pinocchio {theirs:.2f}"),
        Figure("times faster than a loop over aba", f"{theirs / step:.1f}", ">= 20", ratio=True),
        Figure("largest difference after 200 ms, rad", f"{gap:.1e}", "<= 1e-5", "pinocchio", ratio=True),
        Figure("controlled step with friction, one lane, us", f"{controlled_step(repeats):.2f}", "<= 4"),
    ]


def controlled_step(repeats: int) -> float:
    """Give the processor time of a sample of the compiled loop, us: 20 s with friction and controller."""
    scene = yumi_arm()
    mechanism = mechanism_of(scene.model, scene.truth)
    motion = smooth_motion(7).at(STEP * np.arange(20_000))
    gains = default_gains(mechanism, motion.position[::50], 5.0)
    loop = Loop(mechanism, ControlLaw.of_joints(gains), STEP)
    start, inputs = loop.start(motion), Inputs(mechanism.torque(motion), motion.position, motion.velocity)
    return processor_seconds(lambda: loop.run(start, inputs), repeats=repeats) / 20_000 * 1e6


def smooth_arm() -> Mechanism:
    """Give the scene's arm without Coulomb friction, whose reversals the loop would not see."""
    scene = yumi_arm()
    model = standard_model(scene.robot, ("rigid_body", "rotor_inertia", "viscous"))
    place = {
        parameter.name: value for parameter, value in zip(scene.model.parameters, scene.truth, strict=True)
    }
    return mechanism_of(model, np.array([place[parameter.name] for parameter in model.parameters]))


def windows_of(mechanism: Mechanism, windows: int) -> tuple[MotionState, np.ndarray]:
    """Give starting states along a smooth motion, and the torque (steps, joints, windows) that follows it."""
    motion = smooth_motion(7)
    begins = 0.1 * np.arange(windows)
    torque = [mechanism.torque(motion.at(begins + STEP * step)).T for step in range(STEPS + 1)]
    return motion.at(begins), np.array(torque)


def peer(mechanism: Mechanism) -> Any:  # noqa: ANN401 (pinocchio publishes no types)
    """Build pinocchio's model with the same bodies and rotors."""
    model = pinocchio_model(mechanism.robot)
    for number, body in enumerate(mechanism.bodies[8], start=1):
        mass, centre, inertia = mass_properties(body)
        model.appendBodyToJoint(number, pin.Inertia(mass, centre, inertia), pin.SE3.Identity())
    model.armature = np.diag(mechanism.inertia).copy()
    return model


def looped(
    model: Any,  # noqa: ANN401 (pinocchio publishes no types)
    mechanism: Mechanism,
    start: MotionState,
    torque: np.ndarray,
    windows: int,
) -> np.ndarray:
    """Simulate window after window, step after step, with pinocchio; gives (windows, steps, 2, joints)."""
    data = model.createData()
    damping = np.diag(mechanism.damping).copy()
    out = np.empty((windows, STEPS + 1, 2, model.nv))
    for window in range(windows):
        q, v, tau = start.position[window], start.velocity[window], torque[:, :, window].copy()
        out[window, 0, 0], out[window, 0, 1] = q, v
        for step in range(STEPS):
            first = pin.aba(model, data, q, v, tau[step] - damping * v)
            ahead = v + STEP * first
            second = pin.aba(model, data, q + STEP * v, ahead, tau[step + 1] - damping * ahead)
            q = q + 0.5 * STEP * (v + ahead)
            v = v + 0.5 * STEP * (first + second)
            out[window, step + 1, 0], out[window, step + 1, 1] = q, v
    return out


def difference(mechanism: Mechanism, start: MotionState, torque: np.ndarray, windows: int) -> float:
    """Give the largest difference in position (rad) between the two."""
    some = MotionState(start.position[:windows], start.velocity[:windows], start.acceleration[:windows])
    drive = Drive(STEP, np.ascontiguousarray(torque[:, :, :windows]))
    ours = rollout(mechanism, States.starting(mechanism, some), drive).position
    theirs = looped(peer(mechanism), mechanism, start, torque, windows)[:, :, 0]
    return float(np.abs(ours.transpose(2, 0, 1) - theirs).max())
