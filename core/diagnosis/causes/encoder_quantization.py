"""Candidate cause: an encoder resolution that is too coarse for the derivatives of the motion."""

from dataclasses import dataclass

import numpy as np

from ...arrays import JointSeries, JointVector, Mask
from ...dynamics.prediction import Prediction
from ...log.defects.resolution import FEWEST_INCREMENTS, NEAR, Resolution
from ...log.defects.stretch import stretches
from ...log.model import JointLog
from ...robot.joint_units import joint_unit, prismatic_joints
from ..dataset.dataset import Dataset
from ..thresholds.dataset import SAMPLE_CHECKS
from .protocol import Quantity
from .sample_check import Corruption, SampleCheck, SampleFinding, disturbance, share_of_residual


@dataclass(frozen=True)
class EncoderQuantization(SampleCheck):
    """Candidate cause: a coarse encoder."""

    id = "encoder_quantization"
    title = "Encoder resolution too coarse"
    units = (("lsb", "rad"),)
    experiment = "slow motion, which passes many samples within one step"
    beyond_repair = "The joint's position between two counts of its encoder is not in the log"

    def examine(self, dataset: Dataset, operating_point: Prediction) -> tuple[SampleFinding, ...]:
        """Round each joint's smooth motion to its own steps and measure the effect on the torque."""
        steps = np.max([_steps(motion.log) for motion in dataset.motions], axis=0)
        found, kinds = [], prismatic_joints(dataset.robot)
        for joint in np.flatnonzero(steps > 0.0).tolist():
            gained = disturbance(dataset, operating_point, _rounded(joint, float(steps[joint])))
            unit = joint_unit(dataset.robot, joint + 1, "rad")
            share = share_of_residual(dataset, operating_point, gained)
            of_torque = _of_torque(dataset, gained)
            if _matters(
                float(share.max()), float(of_torque.max()), stands_out=_stands_out(steps, joint, kinds)
            ):
                found.append(_finding(joint, (float(steps[joint]), unit), share, of_torque))
        return tuple(found)


def _stands_out(steps: JointVector, joint: int, prismatic: Mask) -> bool:
    """Tell whether a joint's steps are much coarser than those of the robot's other encoders of its kind."""
    alike = (prismatic == prismatic[joint]) & (steps > 0.0)
    alike[joint] = False
    others = steps[alike]
    return bool(len(others) and steps[joint] > SAMPLE_CHECKS.coarser * np.median(others))


def _matters(share: float, of_torque: float, *, stands_out: bool) -> bool:
    """Tell whether rounding is reported, by its largest shares of a residual and of a torque.

    None makes more than all of a torque: then parameters that the motion leaves open do.
    """
    if of_torque > 1.0:
        return False
    if stands_out and of_torque > SAMPLE_CHECKS.coarse_of_torque:
        return True
    return of_torque > SAMPLE_CHECKS.rounding_of_torque and share > (
        SAMPLE_CHECKS.coarse_share if stands_out else SAMPLE_CHECKS.rounding_share
    )


def _of_torque(dataset: Dataset, gained: JointSeries) -> JointVector:
    """Give the RMS of an error over the torque's, per joint; none where no torque was measured."""
    error, torque = (np.sqrt(np.mean(series**2, axis=0)) for series in (gained, dataset.torque))
    measured = dataset.usable.any(axis=0) & (torque > 0.0)
    return np.asarray(np.divide(error, torque, out=np.zeros_like(error), where=measured))


def _finding(
    joint: int, size: tuple[float, str], share: JointVector, of_torque: JointVector
) -> SampleFinding:
    step, unit = size
    return SampleFinding(
        site=(joint + 1,),
        quantities=(Quantity("lsb", joint + 1, unit, step, 0.0),),
        statement=(
            f"Encoder resolution of joint {joint + 1}: steps of {step:.3g} {unit}, whose rounding accounts "
            f"for {100.0 * min(1.0, float(share.max())):.2g} % of joint {int(share.argmax()) + 1}'s residual "
            f"and for {100.0 * float(of_torque.max()):.2g} % of joint {int(of_torque.argmax()) + 1}'s torque"
        ),
        statistic=float(share.max()),
        p_value=(2.0 * NEAR) ** FEWEST_INCREMENTS,
        residual_share=share,
    )


def _steps(log: JointLog) -> JointVector:
    resolution = Resolution(log.samples)
    for stretch in stretches(log.source):
        resolution.update(stretch)
    return resolution.lsb("position")


def _rounded(joint: int, step: float) -> Corruption:
    def corrupt(position: JointSeries, velocity: JointSeries, rng: np.random.Generator) -> JointSeries:
        del velocity
        error = np.zeros_like(position)
        column = position[:, joint] + step * rng.random()
        error[:, joint] = step * np.round(column / step) - column
        return error

    return corrupt
