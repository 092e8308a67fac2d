"""Hold the numbers that decide which causes the search names."""

from dataclasses import dataclass

from ...numerics.likelihood import UNDECIDED


@dataclass(frozen=True)
class Selection:
    """Compare two hypotheses by their criteria, twice the log-likelihood less the penalty."""

    undecided: float = UNDECIDED
    """Difference of twice the log-likelihood (less the penalty) below which neither hypothesis is preferred.
    It decides whether an alternative is distinguished, a swap or a restart is better, and a round of joint
    refinement gains anything. Source: Burnham & Anderson, Model Selection (2002), ch. 2."""


@dataclass(frozen=True)
class Entry:
    """Decide whether a candidate may join a hypothesis. All are set by hand unless a source is named."""

    level: float = 1e-4
    """Probability of naming a first cause in a log without effects, all candidates together."""
    further_level: float = 1e-7
    """Probability, beside another cause, whose columns are not exact."""
    event_level: float = 1e-6
    """Probability, for a cause in short spans: it is searched where the noise is largest."""
    confirmed: float = 0.01
    """Probability, in the motion's own band, for a cause that position noise resembles and that entered in
    the wider one."""
    rare: float = 0.1
    """Share of a joint's rows below which a cause counts as one in short spans."""
    unchanged: float = 0.9
    """Ratio of the likelihood ratios with and without the other causes from which a cause on a joint of its
    own is judged at `level`."""
    least_share: float = 0.004
    """Share of a joint's prewhitened square that a cause has to explain."""
    row_limit: float = 16.0
    """Squared standard deviations that one row may count for, so that no spike decides."""
    bound_factor: float = 4.0
    """Factor between the predicted likelihood ratio of a candidate and the most that its fit may bring.
    Source: the fits of all candidates of 86 simulated logs, docs/decisions.md."""
    bound_excess: float = 500.0
    """Likelihood ratio that the fit may bring beyond that factor. Source: as for `bound_factor`."""
    least_clear: float = 1e-3
    """Share of a candidate's squared columns outside the span of the model below which it is not
    identifiable."""


@dataclass(frozen=True)
class Alignment:
    """Search the delay of all torques by shifting them. All are set by hand."""

    furthest: float = 0.04
    """Delay, s, of either sign that is tried first, with its half, quarter and eighth: nearly the largest
    that is admissible."""
    tolerance: float = 2e-4
    """Seconds to which the likeliest is refined; its column does the rest."""


@dataclass(frozen=True)
class Holdout:
    """Judge a cause by held-out rows. All are set by hand unless a source is named."""

    share: float = 0.25
    """Share of the expected likelihood ratio on held-out rows that has to be reached there."""
    deviations: float = 2.5
    """Standard deviations of that likelihood ratio by which it may fall short instead."""
    over_largest: float = 2.5
    """Ratio of a held-out block's mean square to the largest fitted block's from which it is an outlier.
    Source: 1,152 simulated logs, docs/decisions.md."""
    over_usual: float = 6.0
    """Ratio of the same to the mean of the fitted blocks, which has to be exceeded as well."""
    least_rows: int = 8
    """Rows of a block, or of a window in which a burst is sought, from which on it is judged."""
    as_many: float = 0.5
    """Share of the rows held out first that other held-out blocks must have, per joint."""
    block_rows: int = 25
    """Rows, about half a second, that are drawn together for the interval of a gain."""


@dataclass(frozen=True)
class Masking:
    """Decide whether a cause is only what another one leaves.

    All are set by hand unless a source is named.
    """

    kept: float = 0.5
    """Share of its likelihood ratio that a cause has to keep: beside another one if it is no alternative to
    it, beyond what others leave, over unnamed patterns if it acts in short spans, and at the operating point
    that it yields. Source for what others leave: 686 and 840 simulated logs, docs/decisions.md."""
    left: float = 0.25
    """Share of a cause's likelihood ratio, per joint, that its columns' error may leave."""
    event_over_other: float = 0.05
    """Share of another cause's likelihood ratio that a cause in short spans has to reach. Source: false
    contacts beside strong effects in simulated logs reached 0.04, docs/decisions.md."""
    event_level: float = 1e-30
    """Probability below which a cause in short spans is accepted all the same. Source: false contacts beside
    strong effects in simulated logs reached 1e-25, docs/decisions.md."""
    within: float = 0.9
    """Share of a span's rows in which another cause acts from which on the span is that one's."""


@dataclass(frozen=True)
class Search:
    """Limit the search. A larger number costs time; a smaller one may miss a cause.

    All are set by hand unless a source is named.
    """

    causes: int = 5
    """Causes that are named at most. One that acts on most joints counts once."""
    tried: int = 16
    """Candidates of a scan that are fitted."""
    fitted_whole: int = 4
    """Best candidates that are fitted with the noise of all joints estimated anew."""
    swaps: int = 6
    """Candidates that are fitted in a member's place, for a swap or as alternatives."""
    scored_anew: int = 24
    """Best candidates of a scan that are scored again at the present operating point."""
    cached_change: float = 0.01
    """Share of a joint's torque by which predictions may differ for columns to be used again. Source: at 5 %
    a measured log was answered otherwise, docs/decisions.md."""


@dataclass(frozen=True)
class Refinement:
    """Decide how scalars and operating point are refined, and how well a scalar is known.

    All are set by hand unless a source is named.
    """

    rounds: int = 8
    """Rounds of joint refinement at most."""
    onset_joints: int = 3
    """Joints that decide when a cause begins to act, those with the largest effect."""
    onsets: int = 12
    """Likely instants of onset that are compared."""
    interval: float = 1.96
    """Standard deviations of a normal variable on each side that hold 95 %. A quantile of the normal law."""
    drop: float = 0.5
    """Fall of twice the log-likelihood over one step from which on its curvature is read."""


SELECTION, ENTRY, HOLDOUT, ALIGNMENT = Selection(), Entry(), Holdout(), Alignment()
MASKING, SEARCH, REFINEMENT = Masking(), Search(), Refinement()
