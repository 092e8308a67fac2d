"""List the estimators that can be asked for by name; a new one adds its file and one line here."""

from collections.abc import Mapping

from .irls import IterativelyReweighted
from .method import Estimator
from .ols import OrdinaryLeastSquares
from .sdp import SemidefiniteProgramme
from .wls import WeightedLeastSquares

_LISTED: tuple[Estimator, ...] = (
    SemidefiniteProgramme(),
    OrdinaryLeastSquares(),
    WeightedLeastSquares(),
    IterativelyReweighted(),
)
ESTIMATORS: Mapping[str, Estimator] = {estimator.name: estimator for estimator in _LISTED}
"""The estimators by name, the default first."""
