"""Say how a robot is to be estimated: which estimator, which solver, how strongly the prior pulls.

Apart from what estimates, so that a request can be checked where nothing is computed.
"""

from dataclasses import dataclass, field

from ..errors import OptionError
from .constraints import Bounds
from .methods.method import Estimator
from .methods.registry import ESTIMATORS

SOLVERS = ("clarabel", "cvxpy")
PULL = 0.02
"""Weight of the pull towards the prior, in units of chi^2 per squared scale. A parameter that lies one scale
from the prior is pulled by a fiftieth of a deviation at most, however long the log; what the motion leaves
open goes to the prior all the same."""


@dataclass(frozen=True)
class EstimateOptions:
    """Choose how to estimate."""

    estimator: str = "sdp"
    """One of the registry's names."""
    solver: str = "clarabel"
    """``clarabel`` called directly, or ``cvxpy``."""
    robust: bool = False
    """Weigh rows with Huber's function under the semidefinite programme too."""
    weigh_reversals: bool = True
    """Weigh rows beside a reversal, where the direction of friction is in doubt, by their own noise."""
    pull: float = PULL
    entropy: float = 0.0
    """Weights of the squared and of the entropic distance to the prior."""
    bounds: Bounds = field(default_factory=Bounds)

    @property
    def method(self) -> Estimator:
        """Give the estimator of that name."""
        return ESTIMATORS[self.estimator]

    def __post_init__(self) -> None:
        """Refuse unknown names and weights that are not valid."""
        if self.estimator not in ESTIMATORS or self.solver not in SOLVERS:
            raise OptionError(
                "the estimator or solver is not known",
                evidence={
                    "estimator": self.estimator,
                    "known": list(ESTIMATORS),
                    "solver": self.solver,
                    "solvers": list(SOLVERS),
                },
                remedy="choose one of the known names",
            )
        without_effect = self._without_effect()
        if without_effect:
            raise OptionError(
                f"{' and '.join(without_effect)} would have no effect on this estimator",
                evidence={"estimator": self.estimator, "without_effect": without_effect},
                remedy="ask for estimator sdp, or leave these options out",
            )
        if not 0.0 < self.pull <= 1e6 or not 0.0 <= self.entropy <= 1e6:
            raise OptionError(
                "the weights of the prior are not valid",
                evidence={"pull": self.pull, "entropy": self.entropy},
                remedy="give a pull above 0 and up to 1e6, and an entropy from 0 to 1e6",
            )
        if self.entropy > 0.0 and self.solver != "cvxpy":
            raise OptionError(
                "the entropic prior is stated in cvxpy only",
                evidence={"entropy": self.entropy, "solver": self.solver},
                remedy="ask for solver cvxpy together with entropy",
            )

    def _without_effect(self) -> list[str]:
        """List the options that have been set and would not act on this estimator."""
        acts = {
            "bounds": self.method.feasible,
            "entropy": self.method.feasible,
            "robust": self.method.row_weights,
        }
        is_set = {"bounds": self.bounds != Bounds(), "entropy": self.entropy > 0.0, "robust": self.robust}
        return [name for name in acts if is_set[name] and not acts[name]]
