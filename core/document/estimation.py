"""Say by which estimator a robot was fitted, how it ended, and how its instruments differ."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from ..arrays import JointVector
from ..estimate.kalman.innovations import Innovations, Track
from ..estimate.methods.registry import ESTIMATORS
from ..estimate.simulator import SimulationSetup
from ..identification.choice import BIASED
from ..identification.doubts import LEAST_SQUARES
from ..identification.flexible import FlexibleJoint
from ..identification.result import Identification
from ..precision.endogeneity import SIGNIFICANCE, Endogeneity
from ..precision.inference import INTERVAL_95

if TYPE_CHECKING:
    from ..simulation.control.controller_check import ControllerCheck


def estimation_fields(found: Identification) -> dict[str, object]:
    """Tell of the estimator, of every step that it took, and of the motion that it simulated."""
    method, ended = ESTIMATORS[found.estimator], found.convergence
    return {
        "estimator": found.estimator,
        "title": method.title,
        "choice": None if found.choice is None else vars(found.choice),
        "statements": list(_statements(found)),
        "constrained": method.feasible,
        "converged": ended.converged,
        "stop_reason": ended.reason,
        "steps": [vars(step) for step in ended.steps],
        "start_error_percent": found.start_percent,
        "simulation": _simulation(found) if method.iterative else None,
        "instruments": None if found.endogeneity is None else vars(found.endogeneity),
        "attenuation": {
            "inertia_percent": 100.0 * found.attenuation.missed,
            "position_noise": found.attenuation.noise,
            "cutoff_hz": found.attenuation.cutoff_hz,
        },
        "innovations": None if found.innovations is None else vars(found.innovations),
        "over_time": None if found.track is None else _over_time(found.track),
        "flexible_joints": [_flexible(joint) for joint in found.flexible_joints],
    }


def _flexible(joint: FlexibleJoint) -> dict[str, object]:
    """Give what is known of a joint's spring, and the numbers by which the logs show it."""
    around = INTERVAL_95 * np.array([-1.0, 1.0])
    return {
        "joint": joint.joint,
        "quantities": [
            vars(quantity)
            | {
                "relative_deviation_percent": 100.0 * quantity.standard_deviation / abs(quantity.value)
                if quantity.value
                else np.inf,
                "interval_95": quantity.value + around * quantity.standard_deviation,
            }
            for quantity in joint.quantities
        ],
        "evidence": dict(joint.evidence),
    }


def _over_time(track: Track) -> dict[str, object]:
    """Give the parameters at the ends of the fitted blocks, in the order of the base parameters."""
    return {**vars(track), "log": [number + 1 for number in track.log]}


def _simulation(found: Identification) -> dict[str, object]:
    """Say what drove the simulated robot along the logs."""
    asked = found.simulation.options
    source = {"from": asked.source, "bandwidth_hz": asked.bandwidth_hz, "substeps": asked.substeps}
    if not ESTIMATORS[found.estimator].sources:
        source["window_seconds"] = asked.window_seconds
    return source | {
        "position_rms": found.position_rms,
        "controllers": [_controller(check) for check in found.simulation.controllers],
        "periods": [other.seconds for other in found.simulation.periods],
    }


def _controller(check: "ControllerCheck") -> dict[str, object]:
    """Describe a log's controller, and how well it recomputes the log's command."""
    return {
        "channel": check.channel,
        **vars(check.model),
        "declared": [name for name, _ in check.declared.given()],
        "command_residual_percent": [100.0 * share for share in check.tried[0].residual],
    }


def _statements(found: Identification) -> Iterator[str]:
    """Say the same in sentences, for people."""
    method, ended = ESTIMATORS[found.estimator], found.convergence
    chosen = "" if found.choice is None else f" It was chosen because {found.choice.reason}."
    yield f"Estimator: {method.title} ({found.estimator}).{chosen}"
    yield from _beside(found.simulation)
    if method.iterative:
        steps = len(ended.steps)
        went = "simulated" if found.innovations is None else "filtered"
        went = "went over" if found.simulation.periods else went
        yield f"It {went} the logs {steps} time{'s' * (steps != 1)}: {ended.reason}."
    if found.innovations is not None:
        yield _foreseen(found.innovations)
    if found.endogeneity is not None:
        yield _difference(found.endogeneity)
    yield from map(_springs, found.flexible_joints)
    if found.estimator in LEAST_SQUARES:
        yield from _attenuated(found.attenuation.missed)


def _beside(simulation: SimulationSetup) -> Iterator[str]:
    """Say what told of the motion beside the measured one."""
    for number, check in enumerate(simulation.controllers, start=1):
        yield _recognised(number, check)
    for number, other in enumerate(simulation.periods, start=1):
        told = f"The motion of log {number} repeats every {other.seconds:.6g} s"
        yield f"{told}; each period is held beside the others."


def _recognised(number: int, check: "ControllerCheck") -> str:
    model, worst = check.model, 100.0 * check.tried[0].worst
    kind = {"pd": "a PD controller", "cascade": "a cascade of position and speed"}[model.kind]
    rule = model.velocity.replace("_", " ")
    return (
        f"Log {number} was driven by {kind} (velocity: {rule}, delay {model.delay_samples} samples), which "
        f"recomputes its {check.channel.replace('_', ' ')} within {worst:.2g} %."
    )


def _attenuated(shares: JointVector) -> Iterator[str]:
    sizes = np.nan_to_num(np.abs(shares))
    if np.max(sizes, initial=0.0) > 0.1 * BIASED:
        joint = int(np.argmax(sizes))
        yield (
            f"Noise of positions attenuates the inertias that least squares finds by "
            f"{100.0 * sizes[joint]:.2g} % at most (joint {joint + 1})."
        )


def _springs(joint: FlexibleJoint) -> str:
    """Say what is known of a joint's spring."""
    known = {quantity.name: quantity for quantity in joint.quantities}

    def told(name: str) -> str:
        quantity = known[name]
        return f"{quantity.value:.4g} {quantity.unit} (standard deviation {quantity.standard_deviation:.2g})"

    return (
        f"Joint {joint.joint} is flexible: stiffness {told('stiffness')}, damping {told('damping')}, rotor "
        f"{told('motor_inertia')}; motor and link swing against each other at {told('natural')}, the link "
        f"alone at {told('antiresonance')}."
    )


def _foreseen(told: Innovations) -> str:
    """Say how well a filter foresaw the positions."""
    sizes = sorted({f"{float(size):.2g}" for size in (told.variance.min(), told.variance.max())}, key=float)
    return (
        f"What it did not foresee of the positions has {' to '.join(sizes)} times the variance that it "
        f"expected. Its blocks scatter {told.dispersion:.2g} times as much (variance), which the deviations "
        "of the parameters contain."
    )


def _difference(found: Endogeneity) -> str:
    matters = "less than the uncertainty"
    if found.largest > 1.0:
        matters = "which is not significant" if found.p_value > SIGNIFICANCE else "which is significant"
    weak = f" The weakest instrument has a correlation of {found.weakest:.2g}." if found.weakest < 0.5 else ""
    return (
        f"The largest difference of a parameter to least squares is {found.largest:.2g} standard deviations, "
        f"{matters}.{weak}"
    )
