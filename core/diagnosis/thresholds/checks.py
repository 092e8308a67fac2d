"""Hold the numbers that decide how findings are judged, and what is called unexplained."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Alternatives:
    """Compare a finding with its alternatives. All are set by hand."""

    other_share: float = 0.03
    """Share of a finding's likelihood ratio by which it must lead over any other cause."""
    similar_share: float = 0.15
    """The same over a cause with nearly parallel columns: their error grows with the effect."""
    first_order_share: float = 0.4
    """The same where the two agree to first order in frequency."""
    unnamed_share: float = 0.25
    """Share of a finding's likelihood ratio by which an unnamed pattern has to lead to refute it."""
    least_expected: float = 4.0
    """Likelihood ratio expected on held-out rows below which these decide little."""
    least_gain: float = 0.5
    """Per cent by which a cause has to reduce the error on held-out rows."""
    least_ratio_listed: float = 0.1
    """Share of a finding's likelihood ratio from which a refuted alternative is listed."""


@dataclass(frozen=True)
class Verdict:
    """Decide what is called unexplained. All are set by hand."""

    unexplained_share: float = 0.03
    """Share of a joint's mean square residual, lower end of the 95 % interval, from which on it is
    structure."""
    at_rest: float = 0.9
    """Share of a joint's rows with free friction from which on it hardly moves."""


@dataclass(frozen=True)
class Unnamed:
    """Decide which unnamed patterns are reported. All are set by hand."""

    tried: int = 3
    """Best patterns that are fitted."""
    least_seconds: float = 4.0
    """Seconds that a log counts for at least when rates are laid out."""
    most_seconds: float = 60.0
    """Seconds that it counts for at most: what is slower is drift."""
    level_rows: int = 5
    """Rows that are averaged before the kurtosis is taken."""
    level_deviations: float = 5.0
    """Standard deviations below the kurtosis of normal noise from which levels are reported."""
    burst_seconds: float = 0.3
    """Seconds of a window in which a burst is sought."""
    burst_distance: float = 0.5
    """Seconds from a window to the rows that it is compared with."""
    burst_ratio: float = 6.0
    """Ratio of the median size in a window to the RMS elsewhere from which it is a burst."""
    means: int = 4
    """Lengths of a moving mean that are tried."""
    shortest_mean: float = 0.08
    """The least of them, s. A joint that sticks, and columns of noisy positions, leave the same as one of
    up to 30 ms."""
    longest_mean: float = 0.3
    """The largest of them, s."""


@dataclass(frozen=True)
class Smoothed:
    """Decide whether torques were smoothed forwards and backwards.

    Source: shares of what the likeliest moving mean takes away. On four smoothed logs of a UR10e, a TX40 and
    a Panda their median is 0.65 to 1.1. As measured, none of the UR10e and two of the TX40 exceed 0.45; six
    of the Panda's do, whose positions are noisy.
    """

    share: float = 0.45
    """Share of what a moving mean takes away that a joint lacks at least."""
    unknown: float = 0.25
    """Standard deviation of a share, or over a share above one, from which on it is not known."""
    most: float = 0.6
    """Share of the joints whose share is known that have to lack it."""
    joints: int = 2
    """Such joints at least: one may have a spring."""
    changed: float = 0.1
    """Share of its torque by which a finding that is no part of the smoothing changes beside it. Source: on
    those logs false delays, lags and contacts change by 0.14 to 0.89, a true ripple, payload and frictions of
    the load by 0.013 to 0.061. False springs and frictions of the velocity change as little as true findings:
    they are doubtful in any case."""


@dataclass(frozen=True)
class Separation:
    """Decide which causes a log can distinguish, before any is searched for. All are set by hand."""

    scalars: int = 3
    """Values of a cause's scalars that are tried, from its whole grid."""


@dataclass(frozen=True)
class Confidence:
    """Turn a finding's evidence into a probability that its cause is the right one.

    Source: Platt, Advances in Large Margin Classifiers (1999), for the form. The coefficients stand in
    `checks/confidence.json`, which `tests.hidden calibrate` writes.
    """

    certain: float = 0.99
    """Probability, the highest that is reported. Set by hand."""
    doubtful: float = 0.5
    """Probability that no finding exceeds while a conflict or more than half of a joint's torque is left,
    while an alternative explains more, while no held-out row shows a gain, while it scatters as much between
    parts of the log, or where its columns do not represent its size. Set by hand."""
    clear_statistic: float = 25.0
    """Likelihood ratio at which the strength is 0; each further one of that size adds 1."""
    most_strength: float = 2.0
    """Largest strength."""
    least_lead: float = -1.0
    """Smallest lead over the alternatives, in units of an undecided difference."""
    most_lead: float = 4.0
    """Largest lead, in the same units."""


@dataclass(frozen=True)
class BlockScatter:
    """Decide whether a finding exceeds its scatter between parts of the log."""

    blocks: int = 40
    """Blocks that the log is cut into, so that some 30 are left where every fourth is held out. Set by hand:
    of 20, Fisher's law asks twice the statistic of causes that are searched among thousands."""
    level: float = 1e-3
    """Probability, corrected for all that was scanned, above which a finding is doubtful. Source: of 54 true
    causes of simulated logs, of strength 0.3 and 1, all but two of backlash have at most 7e-4, most below
    1e-9. On measured robots all that was changed on purpose has at most 7e-7; what was named besides and
    depends on the change has 2e-3 and 7e-3, springs of joints that gain nothing held out 0.05 to 1. By blocks
    left out, three false causes of a changed UR10e have 0.02 to 1, those of the sound log at most 5e-4."""
    ridge: float = 1e-6
    """Share of a column's square that keeps the equations of some blocks regular: what they do not show
    stays. Set by hand, above rounding of the products and below what any log shows."""


@dataclass(frozen=True)
class BetweenLogs:
    """Decide whether a log holds so little of a finding that it is another log's alone."""

    least: float = 0.5
    """Size in a log over that in all logs: of an effect that one of two equal logs has, they hold none of it
    and twice as much. Set by hand, between that and one."""
    clearness: float = 3.0
    """Deviations by which it has to be smaller. Source: the usual level of 0.1 %."""


@dataclass(frozen=True)
class BetweenJoints:
    """Decide whether joints confirm a finding, each by its own torque. Set by hand."""

    clearness: float = 3.0
    """Deviations from zero from which on a joint shows it."""
    joints: int = 3
    """Joints that have to show it: two agree by chance more easily."""
    level: float = 0.01
    """Probability of sizes so different, below which joints do not agree."""


@dataclass(frozen=True)
class OneSize:
    """Decide whether one number of the whole robot has several sizes."""

    apart: float = 0.15
    """Standard deviation, over the size in all, that the errors of other effects and of first-order columns
    may give every size. Source: the sizes by joint of true delays and lags of 10 simulated logs deviate by at
    most 0.14; those of channels that are read in turn by 0.5 to 1.2, those of clocks that drift apart, by
    quarters of the log, by 0.4 to 0.7."""
    level: float = 0.01
    """Probability of sizes so different, below which they are not one. Set by hand, to that at which joints
    do not confirm a finding."""
    parts: int = 4
    """Parts of the logs whose sizes may have a trend. Set by hand: a few, each of several blocks."""


@dataclass(frozen=True)
class PositionNoise:
    """Decide whether noise of the positions may account for a finding."""

    times: float = 2.0
    """Ratio of a finding's likelihood ratio to what noise may account for, below which it is doubtful.
    Source: on sound logs of simulated arms with encoders of 0.01 to 0.1 degrees, delays and springs have 0.6
    to 1.7; true ones of simulated logs have at least 2.8, on measured robots about 6 and more, but for a
    UR10e, whose positions have less noise in the band than at high frequencies: a true delay has 0.1."""
    least_gain: float = 0.02
    """Share of what all joints gain, from which a joint's noise counts. Set by hand."""
    level: float = 1e-3
    """Probability by the scatter between blocks, above which instruments do not see an effect, and below
    which they see another size. Source: true causes of simulated logs, some backlashes apart, have at most
    1e-4 and at least 2e-3, those of a measured UR10e, Panda and EMPS at most 1e-6 and at least 0.01."""
    change: float = 0.5
    """Share of a finding by which instruments have to find more or less for it to be doubtful whatever it
    explains. Source: true causes have at most 0.3; false ones of measured robots 0.5 to 1.5."""


@dataclass(frozen=True)
class SpringResonance:
    """Decide whether the stiffness of a joint is that of its resonance."""

    times: float = 1.5
    """Ratio of a stiffness to that of its resonance and the moved inertia, or its inverse, beyond which a
    finding is doubtful. Source: elastic joints of 9 simulated logs, and a hysteretic gear of an independent
    simulation, have 0.97 to 1.01; a base that gives has 3.4 to 19, a load that swings 2.2 to 4.6, encoders
    behind the springs of all joints 2.1 to 7.8."""
    deviations: float = 2.0
    """Standard deviations of the ratio's logarithm by which it has to differ, too. Set by hand."""


@dataclass(frozen=True)
class StructureLeft:
    """Decide whether what is left beside a finding is too much for its name."""

    statistic: float = 12.0
    """Likelihood ratio of smooth functions of the motion from which on structure is left on a joint. Source:
    of one variance, noise exceeds it on one joint in 3,000 for each of four kinds of functions; on simulated
    logs with true causes it has at most 10, but for errors of first-order columns."""
    share: float = 0.15
    """Share of what a finding explains on a joint, beyond which structure takes the joint from its evidence.
    Source: beside true causes of 50 simulated logs it is at most 0.11; a delay of a Panda, with 0.16
    to 0.29 on four joints, has at most 0.12 on the others. Names for cables and hoses: mostly 0.2 to 5."""
    share_of_all: float = 0.5
    """The same of all such joints over all that a finding acts on, beyond which it is doubtful whatever other
    joints show. Source: delays of a measured Panda and TX40 have 0.18 and 0.07, false names that other joints
    seem to show 0.6 to 1.3. Two errors of the Panda's description have 1.2 and 2: joints confirm them."""
    level: float = 1e-7
    """Probability, corrected for all that was scanned, above which the other joints do not show a finding:
    that at which causes enter beside others. Set by hand."""


@dataclass(frozen=True)
class Residual:
    """Decide whether a model fits a joint at all. Set by hand."""

    failed: float = 0.5
    """Share of a joint's RMS torque, left by model and findings, from which on the model does not fit it."""


@dataclass(frozen=True)
class AtRest:
    """Find pushes on an arm that stands. All are set by hand."""

    deviations: float = 6.0
    """Standard deviations of a joint's residual in motion by which torque has to change beyond friction."""
    still_share: float = 0.03
    """Share of every joint's RMS speed below which the arm stands, though it may still settle."""
    travel_share: float = 0.1
    """Share of the RMS distance that a joint comes elsewhere in the same time, which it may move within a
    stand."""
    settling_rows: int = 4
    """Rows at either end of a stand in which the filter settles."""
    edge_rows: int = 2
    """Rows at either end, at least, whose median is the torque without a push; twice as many have to lie
    between."""
    edge_share: float = 0.1
    """Share of a long stand's rows at either end that the median is taken over."""


@dataclass(frozen=True)
class Motion:
    """Decide whether a correction worsens the simulated motion. Set by hand."""

    clearly_worse_percent: float = 10.0
    """Growth of a joint's position error, nearer end of its 95 % interval, from which motion is clearly
    worse."""


@dataclass(frozen=True)
class Command:
    """Hold torque channels against the command of the drives. All are set by hand."""

    most_samples: int = 60_000
    """Samples that are looked at: a minute at 1 kHz tells a delay to microseconds."""
    longest: float = 0.1
    """Largest delay that is looked for, s: a longer one is no small error of a channel."""
    same: float = 1e-6
    """Share of the torque that is left where the torque channel is the command itself."""
    steps: int = 8
    """Steps of the fit, which is nearly linear."""
    least_joints: int = 3
    """Joints of which the middle gain is that of sound channels."""
    blocks: int = 20
    """Contiguous blocks from whose scatter deviations are taken."""
    least_shown: float = 0.5
    """Share of a filter's lag that the command has to show."""
    deviations: float = 3.0
    """Standard deviations that are added to what it shows."""


COMMAND, BLOCK_SCATTER, BETWEEN_LOGS = Command(), BlockScatter(), BetweenLogs()
BETWEEN_JOINTS, ONE_SIZE, SMOOTHED = BetweenJoints(), OneSize(), Smoothed()
POSITION_NOISE = PositionNoise()
SPRING_RESONANCE, STRUCTURE_LEFT = SpringResonance(), StructureLeft()
RESIDUAL, SEPARATION, AT_REST, MOTION = Residual(), Separation(), AtRest(), Motion()
ALTERNATIVES, VERDICT, UNNAMED, CONFIDENCE = Alternatives(), Verdict(), Unnamed(), Confidence()
