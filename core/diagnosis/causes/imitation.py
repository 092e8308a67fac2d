"""State which causes imitate each other, and which experiment separates them.

The columns of two causes may be nearly parallel in a motion. Entries are physics: `why` names the property in
which the two differ.
"""

from dataclasses import dataclass

from ..thresholds.checks import ALTERNATIVES


@dataclass(frozen=True)
class Imitation:
    """State that a cause may be another one, how the two differ, and which experiment shows it."""

    cause: str
    other: str
    why: str
    experiment: str
    mutual: bool = True
    """Whether the other one may be this one, too."""
    share: float = ALTERNATIVES.similar_share
    """A lead of less than this share of a finding's likelihood ratio decides nothing: the columns of a real
    robot are not exact, and their error grows with the effect."""
    by_motion: bool = True
    """Whether a motion separates the two; torque never does where it is false."""


IMITATIONS: tuple[Imitation, ...] = (
    Imitation(
        "friction_stribeck",
        "friction_viscous_nonlinear",
        "both bend the friction curve; the Stribeck effect ends at a speed, a power law continues",
        "move the joint at ten constant speeds from 1 % to 100 % of its limit, in both directions",
    ),
    Imitation(
        "friction_stribeck",
        "friction_presliding",
        "both act next to reversals; one depends on speed, the other on the distance travelled since",
        "start from rest with accelerations that differ by a factor of ten: only speed or only distance "
        "aligns them",
    ),
    Imitation(
        "friction_asymmetric",
        "friction_viscous_nonlinear",
        "both bend the friction curve; motion in one direction alone cannot separate them",
        "repeat every constant-speed move in the other direction",
        mutual=False,
    ),
    Imitation(
        "friction_load_dependent",
        "torque_gain",
        "both are proportional to the load; friction changes its sign with the direction of motion",
        "pass the same postures slowly in both directions",
    ),
    Imitation(
        "friction_temperature",
        "torque_offset_drift",
        "both change slowly with time; friction changes its sign with the direction of motion",
        "repeat a slow move in both directions, cold at the start and after half an hour of motion",
    ),
    Imitation(
        "friction_temperature",
        "friction_load_dependent",
        "a payload picked up during the log also increases friction with time",
        "repeat the same motion cold and warm with nothing else changed",
        mutual=False,
    ),
    Imitation(
        "friction_position_dependent",
        "torque_ripple",
        "both are periodic in the angle; only friction changes its sign with the direction of motion",
        "cover the whole range slowly, once in each direction",
    ),
    Imitation(
        "friction_presliding",
        "backlash",
        "both act just after reversals of the velocity; backlash only where the load changes its sign",
        "reverse in postures where gravity keeps the sign of the load: only presliding friction remains",
    ),
    Imitation(
        "friction_presliding",
        "joint_elasticity",
        "both are elastic displacements; the joint's also follows the load without a reversal",
        "accelerate hard without changing the direction of motion",
        mutual=False,
    ),
    Imitation(
        "joint_elasticity",
        "backlash",
        "both displace the link against the motor; elasticity in proportion to the load, backlash where it "
        "changes its sign",
        "repeat in a posture where gravity keeps the sign of the load: only elasticity remains",
    ),
    Imitation(
        "joint_elasticity",
        "time_delay",
        "both delay the torque; a delay is the same on all joints and loads",
        "repeat the motion with and without a payload: the lag of an elastic joint grows with the inertia",
    ),
    Imitation(
        "torque_filter_lag",
        "joint_elasticity",
        "both delay the torque; the lag of an elastic joint depends on joint and load",
        "repeat the motion with and without a payload: a filter stays the same",
        mutual=False,
    ),
    Imitation(
        "time_delay",
        "torque_filter_lag",
        "both delay the torque alike to first order in frequency; a low-pass filter also attenuates fast "
        "motion",
        "excite at several frequencies up to a fifth of the sampling rate: a delay keeps the amplitude",
        share=ALTERNATIVES.first_order_share,
    ),
    Imitation(
        "position_filter",
        "joint_elasticity",
        "both hide fast motion of the links; a filter the same on all joints and at any load",
        "log the positions as the encoders give them, or repeat with a payload: a filter stays the same",
    ),
    Imitation(
        "rotor_inertia_missing",
        "joint_elasticity",
        "both change the torque with the square of the frequency",
        "repeat the motion with a payload: the rotor's torque stays the same",
        mutual=False,
    ),
    Imitation(
        "joint_coupling",
        "friction_asymmetric",
        "while both joints always move alike, the other joint's friction is not separable from this joint's",
        "move each of the two joints alone, then both in the same and in opposite directions",
        mutual=False,
    ),
    Imitation(
        "torque_gain",
        "torque_gain_nonlinear",
        "a nonlinear gain equals another linear gain where the torque keeps its size",
        "hold postures of little, half and full gravity torque",
        mutual=False,
    ),
    Imitation(
        "torque_gain",
        "payload_change",
        "only ratios between joints show a gain; the same gain on all joints equals heavier bodies",
        "repeat the motion with a weighed payload",
        mutual=False,
    ),
    Imitation(
        "torque_gain_nonlinear",
        "torque_saturation",
        "both act at large torques; saturation ends at one level, a nonlinear gain continues",
        "raise a payload step by step (a nonlinear gain shows below the largest torque) and repeat the "
        "motion a tenth slower (the torque then stays below the limit)",
    ),
    Imitation(
        "torque_gain_nonlinear",
        "friction_load_dependent",
        "both grow with the torque; only friction changes its sign with the direction of motion",
        "pass the same loaded posture slowly in both directions",
        mutual=False,
    ),
    Imitation(
        "torque_saturation",
        "external_contact",
        "both act in short intervals; a contact does not need large torques",
        "repeat the motion a tenth slower in free space",
        mutual=False,
    ),
    Imitation(
        "encoder_offset",
        "kinematic_error",
        "a zero error of the joint equals an error of theta in its row of the table",
        "measure the tool's position against the joint angles: torque alone cannot separate the two",
        by_motion=False,
    ),
    Imitation(
        "encoder_offset",
        "gravity_misalignment",
        "for joints that carry the arm against gravity, a tilted base has the effect of a zero error",
        "turn the first joint by half a turn: the effect of a tilted base changes its sign",
    ),
    Imitation(
        "encoder_eccentricity",
        "torque_ripple",
        "both vary with the angle; an angle error grows with acceleration and load, and makes small waves of "
        "the gravity torque at one to three cycles per revolution",
        "pass the same angles slowly and fast, then with a payload: ripple stays the same",
    ),
    Imitation(
        "encoder_eccentricity",
        "encoder_offset",
        "over a small part of a revolution the error hardly changes",
        "move the joint through a whole revolution, or as much of one as its range allows",
        mutual=False,
    ),
    Imitation(
        "kinematic_error",
        "gravity_misalignment",
        "an angle of the first links rotates the whole arm, as a tilted base does",
        "measure the base with a level",
        mutual=False,
    ),
    Imitation(
        "payload_change",
        "torque_offset_drift",
        "in one posture a step of weight equals a step of the offset; in others the weight's torque differs",
        "move all joints after the change, or hold two postures of different gravity torque, early and late",
    ),
    Imitation(
        "payload_change",
        "external_contact",
        "a contact that lasts to the end of the log equals a weight until the arm accelerates",
        "repeat the motion in free space, fast after the change: only a body has inertia",
    ),
    Imitation(
        "payload_change",
        "link_parameters",
        "against a reference, a heavier link equals a body fixed to it; where it may be a body, it is called "
        "one",
        "weigh the link, or check whether something is fixed to it",
    ),
    Imitation(
        "spring_compensator",
        "cable_force",
        "a cable is a spring that is slack over part of the range",
        "hold ten postures spread over the whole range of the joint",
    ),
    Imitation(
        "link_parameters",
        "torque_gain",
        "the last joints' channels measure little but this link: their gain is its size",
        "repeat the motion with a weighed payload",
        mutual=False,
    ),
    Imitation(
        "friction_change",
        "torque_gain",
        "a channel that reads too high shows more of the joint's friction, too",
        "pass the same postures slowly in both directions: friction changes its sign, the load does not",
        mutual=False,
    ),
    Imitation(
        "friction_change",
        "friction_temperature",
        "friction that falls while the joint warms up differs from the reference's",
        "repeat the motion after an hour of warming up",
        mutual=False,
    ),
    Imitation(
        "friction_change",
        "torque_offset_drift",
        "an offset that drifts is on average another offset",
        "record for longer: a drift continues",
        mutual=False,
    ),
    Imitation(
        "torque_dead_zone",
        "friction_load_dependent",
        "both take from the torque; a dead zone only what is small, and it leaves exact zeros",
        "pass slowly through postures in which the torque changes its sign, in both directions",
        mutual=False,
    ),
    Imitation(
        "dropped_samples",
        "timestamp_jitter",
        "a recorder that is faster than the controller repeats rows regularly, and loses nothing",
        "record at the controller's own rate",
        mutual=False,
    ),
    Imitation(
        "timestamp_jitter",
        "encoder_quantization",
        "both add noise to positions; jitter grows with speed and is the same time error on all joints",
        "repeat the motion at half the speed: errors of jitter are halved, rounding errors stay",
    ),
)


def imitations(cause: str) -> dict[str, Imitation]:
    """List what a cause may be instead, by the other cause."""
    own = {entry.other: entry for entry in IMITATIONS if entry.cause == cause}
    return own | {entry.cause: entry for entry in IMITATIONS if entry.mutual and entry.other == cause}
