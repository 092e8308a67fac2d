"""List the estimators that can be asked for by name; a new one adds its file and one line here."""

from collections.abc import Mapping

from .didim import DirectInverse
from .irls import IterativelyReweighted
from .iv import InstrumentalVariables
from .kalman import EXTENDED, UNSCENTED
from .method import Estimator
from .ols import OrdinaryLeastSquares
from .sdp import SemidefiniteProgramme
from .wls import WeightedLeastSquares

_LISTED: tuple[Estimator, ...] = (
    SemidefiniteProgramme(),
    OrdinaryLeastSquares(),
    WeightedLeastSquares(),
    IterativelyReweighted(),
    InstrumentalVariables(),
    DirectInverse(),
    EXTENDED,
    UNSCENTED,
)
ESTIMATORS: Mapping[str, Estimator] = {estimator.name: estimator for estimator in _LISTED}
"""The estimators by name, the default first."""
