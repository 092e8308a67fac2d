"""Hold the numbers that decide what a cause may be: bounds of its size, and the error of its columns."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Admissible:
    """Bound the size of causes by what a robot can have. All are set by hand unless a source is named."""

    lowest_cutoff: float = 0.5
    """Hertz, the least cut-off of a filter of the positions: a lower one leaves no motion. Set by hand."""
    highest_cutoff: float = 1000.0
    """Hertz above which a filter of the positions has no effect in any log's band."""
    encoder_offset: float = 0.5
    """Radians (metres) of an encoder offset: beyond, the table belongs to another robot."""
    encoder_eccentricity: float = 0.3
    """Radians, amplitude of an encoder's eccentricity. Set by hand."""
    eccentricity_represented: float = 0.2
    """Radians of the same above which a finding is doubtful. Source: what the first order of an angle's error
    omits is half of the error, and its columns are good to a tenth; one of 0.18 is found at 0.28."""
    kinematic_error: float = 0.3
    """Radians or metres of an error in the kinematic table."""
    gravity_tilt: float = 0.5
    """Radians between the described and the real direction of gravity."""
    torque_gain: float = 0.9
    """Relative error of a torque channel's gain: below 1, so that its sign is right."""
    time_delay: float = 0.05
    """Seconds of a delay between torque and position."""
    least_filter_lag: float = 2e-4
    """Seconds, time constant below which a filter has no effect in any log's band."""
    filter_lag: float = 0.1
    """Seconds, time constant beyond which no motion is left in the torque."""
    contact_force: float = 1000.0
    """Newton: a larger force would break the robot."""
    contact_lever: float = 0.5
    """Metres from the last frame to a point of contact."""
    contact_deviations: float = 3.0
    """Standard deviations by which a moment may exceed the force at that lever."""
    contacts: int = 5
    """Contacts in one log."""
    payload: float = 500.0
    """Kilogram of a payload's change."""
    payload_centre: float = 1.0
    """Metres, standard deviation beyond which a coordinate of its centre is not reported."""
    body_distance: float = 30.0
    """Squared standard deviations between ten parameters and the nearest body."""
    body_share: float = 0.03
    """The same as a share of the squared effect, for columns that are not exact."""
    significant: float = 2.0
    """Standard deviations from which a number of a cause is taken to differ from zero: the mass of a body, an
    inertia or friction of a coupled motor, a change that is stated among others, a rotor's inertia."""
    coupling_distance: int = 2
    """Joints between which a transmission couples: the next or the one after it."""
    damping_ratio: float = 0.5**0.5
    """Damping ratio of an elastic joint. Source: from there on the response of a spring and its mass has no
    peak at a resonance, and is a lag's."""
    backlash_narrower: float = 8.0
    """Factor by which backlash may be narrower than the width that its crossings were computed for."""
    backlash_wider: float = 5.0
    """Factor by which it may be wider."""
    power_distance: float = 0.1
    """Difference of a friction exponent from 0 and 1, whose columns the model already has."""
    least_power: float = 0.25
    """Friction exponent below which a finding is doubtful: next to reversals much else leaves a residual.
    Source: measured robots whose torque was made late left 0.10 to 0.18; a true 0.4 is known to 0.07."""
    load_friction: float = 0.5
    """Share of the transmitted load above which its friction is doubtful. Source: what loses more than half
    locks itself (Budynas & Nisbett, Shigley's Mechanical Engineering Design, ch. 8, on screws)."""
    presliding_distance: float = 0.3
    """Radians (metres) over which friction may build up after a reversal. Set by hand: measured gears have
    some milliradians; 1.2 were fitted to what a zero error of another joint left."""
    level_deviations: float = 3.0
    """Standard deviations of a presliding level below which a finding is doubtful. Source: measured robots
    whose torque was made late left 2.0 and 2.2; of 12 simulated ones 11 have more than 4."""
    ripple_harmonic: float = 2.0
    """Cycles per revolution of a torque ripple: gravity has one."""
    friction_harmonic: float = 0.5
    """Least cycles per revolution of a friction level: a joint that turns round has one at least, which the
    motion may leave open by a half. Set by hand."""
    ripple_waves: float = 1.5
    """Waves of a ripple within the joint's range below which a finding is doubtful: three half waves at least
    say that it comes again. Source: a spring balance, of an independent simulation, passed for 1.1 waves."""
    least_warm_up: float = 3.0
    """Seconds, time constant of a warm-up and of a drifting offset: no drive of a robot warms up faster."""
    saturation_error: float = 0.03
    """Relative error of the largest predicted torques, which a torque limit is known to. On nine simulated
    logs with a limit they exceeded it by 0.6 to 2.5 %."""
    saturation_excess: float = 0.25
    """Relative excess of the largest predicted torques beyond which a torque limit is none. Set by hand: a
    true limit beside jitter and heavy noise was exceeded by 15 %, a false one by 106 %."""
    saturation_quantile: float = 0.999
    """Quantile of the predicted torques that counts as the largest."""


@dataclass(frozen=True)
class Linearisation:
    """State the relative error of first-order columns, a bound on the accuracy. All are set by hand."""

    usual: float = 0.05
    """Relative, for most causes."""
    transmission: float = 0.15
    """Relative, for backlash and joint elasticity, which move the link against the motor."""
    eccentricity: float = 0.1
    """Relative, for an encoder's eccentricity."""
    position_filter: float = 0.25
    """Relative, for the power of a position filter's time constant: a sixteenth of the cut-off at order 2, an
    eighth at order 1. What a filter took of a reversal comes back with a bounded gain only. On simulated logs
    the power was found 7 to 20 % too small."""


@dataclass(frozen=True)
class Events:
    """Decide which short spans hold a contact. All are set by hand unless a source is named."""

    level: float = 5e-4
    """Probability of an event in a log of noise alone, for spans that are not shifted and stretched."""
    spans: int = 1200
    """Spans of a log of half a minute that a contact's p-value is corrected for. Counted from the grid."""
    onsets: int = 120
    """Instants between two of a payload's grid that the refinement distinguishes, for its p-value.
    Counted."""
    least_share: float = 0.2
    """Share of the best event's score that others have to reach."""
    shortest: float = 0.2
    """Seconds: what is shorter is an outlier, and what begins so soon after another belongs to it."""
    longest: float = 3.2
    """Seconds of the longest span in the grid: what is longer lasts."""
    edge: float = 0.6
    """Standard deviation of an event's edge, in lengths of the event and relative deviations of its force.
    Source: a half sine's edge is known as well as its height, times a little over half its length."""


ADMISSIBLE, LINEARISATION, EVENTS = Admissible(), Linearisation(), Events()
