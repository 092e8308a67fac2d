"""Hold the numbers that decide an audit, each with its unit, meaning and source."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Description:
    """Decide what is said of bodies without a log."""

    light_kg: float = 1e-3
    """Mass below which a moving link has none. Set by hand: the lightest finger weighs grams."""
    heavy_kg_per_m: float = 1000.0
    """Mass of a link over the robot's reach above which it is no robot's. Set by hand: the heaviest arms have
    2,000 kg at 3 m in six links."""
    beyond_metres: float = 0.1
    """What a link reaches beyond the axes that it carries, m, apart from the share below. Set by hand: drives
    and covers of arms of 0.5 to 3 m reach 0.1 to 0.3 m beyond."""
    beyond_share: float = 0.1
    """The share of the robot's reach that is added to it. Set by hand, as above."""
    tip: float = 0.5
    """Length of a link without a successor, as a share of the longest link. Set by hand: its tool is in no
    table."""
    usual: float = 0.3
    """Radius of gyration that a link has as a rule, over the radius of the ball that holds it. Set by hand: a
    uniform ball has 0.77, and links fill a part of theirs."""
    compact: float = 0.01
    """Radius of gyration over that radius below which an inertia is none of a link. Set by hand: a steel ball
    of the same mass has 0.05 and more."""
    unit_spread: float = 3.0
    """Factor within which a common factor is taken for a unit's (1000, 1e6, 1e9). Set by hand: half of what
    keeps units apart on a logarithmic scale would be 30; links differ by three."""
    mirrored_share: float = 0.05
    """Difference of a left and a right link's mass, or principal inertia, from which they are no mirror
    images. Set by hand: files are written with three digits."""
    mirrored_metres: float = 0.002
    """The same for the distance of the mass centre from the joint's axis and along it, m. Set by hand."""
    total_share: float = 0.05
    """Share by which the links may weigh more than the maker's robot. Set by hand: data sheets round."""
    least_share: float = 0.4
    """Share of the maker's mass that moving links have at least; the rest is the base. Set by hand: bases of
    six-joint arms have a tenth to a half."""


@dataclass(frozen=True)
class Log:
    """Decide what logs contradict."""

    slack: float = 0.05
    """Share of the roots of a pseudo-inertia's diagonal by which a description is taken to be off: CAD models
    lack cables and screws. Set by hand: halved, slight differences are named; doubled, 30 mm of a compact
    link are not."""
    p_value: float = 1e-3
    """Probability, corrected for all entries, below which an entry is contradicted. Set by hand."""
    undecided: float = 10.0
    """Difference of the criterion below which another entry explains the log as well. Source: Burnham &
    Anderson, Model Selection (2002), ch. 2: beyond it, a model has essentially no support."""
    tolerated_percent: float = 30.0
    """Held-out torque error (% of RMS) above which the log contradicts the model and not an entry of it, as a
    check of robot and log doubts it. Set by hand."""
    unknown_share: float = 10.0
    """Share of itself by which a contradicted mass or inertia may be off beforehand. Set by hand: what the
    log leaves open stays."""
    unknown_metres: float = 0.3
    """The same of a mass centre, m. Set by hand: about the length of a link."""
    thinnest: float = 1e-3
    """Least second moment of a corrected body over its largest one. Set by hand: a rod of 1 to 30."""


DESCRIPTION, LOG = Description(), Log()
