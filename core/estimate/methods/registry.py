"""List the estimators that can be asked for by name; a new one adds its file and one line here."""

from collections.abc import Mapping

from .didim import DirectInverse
from .irls import IterativelyReweighted
from .iv import InstrumentalVariables
from .method import Estimator
from .ml import MaximumLikelihood
from .ols import OrdinaryLeastSquares
from .piv import PrewhitenedInstrumentalVariables
from .sdp import SemidefiniteProgramme
from .tls import CompensatedLeastSquares
from .wls import WeightedLeastSquares

_LISTED: tuple[Estimator, ...] = (
    SemidefiniteProgramme(),
    OrdinaryLeastSquares(),
    WeightedLeastSquares(),
    IterativelyReweighted(),
    InstrumentalVariables(),
    DirectInverse(),
    CompensatedLeastSquares(),
    MaximumLikelihood(),
    PrewhitenedInstrumentalVariables(),
)
ESTIMATORS: Mapping[str, Estimator] = {estimator.name: estimator for estimator in _LISTED}
"""The estimators by name, the default first."""
