"""List the estimators that can be asked for by name; a new one adds its file and one line here."""

from collections.abc import Mapping

from .auto import Automatic
from .didim import DirectInverse
from .irls import IterativelyReweighted
from .iv import InstrumentalVariables
from .kalman import EXTENDED, UNSCENTED
from .method import Estimator
from .ml import MaximumLikelihood
from .ols import OrdinaryLeastSquares
from .output_error import CLOSED_LOOP_INPUT_ERROR, CLOSED_LOOP_OUTPUT_ERROR, OPEN_LOOP_OUTPUT_ERROR
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
    CLOSED_LOOP_INPUT_ERROR,
    CLOSED_LOOP_OUTPUT_ERROR,
    OPEN_LOOP_OUTPUT_ERROR,
    CompensatedLeastSquares(),
    MaximumLikelihood(),
    PrewhitenedInstrumentalVariables(),
    EXTENDED,
    UNSCENTED,
    Automatic(),
)
ESTIMATORS: Mapping[str, Estimator] = {estimator.name: estimator for estimator in _LISTED}
"""The estimators by name, the default first."""
