"""Name what may be asked of a joint's model; pages and options read it without the computation."""

from collections.abc import Mapping
from typing import Final, Literal, get_args

OrderName = Literal["rigid", "flexible"]
EstimatorName = Literal["srivc", "clsrivc"]
ORDER_NAMES: Final[tuple[OrderName, ...]] = get_args(OrderName)
ESTIMATORS: Final[Mapping[EstimatorName, str]] = {
    "srivc": "refined instrumental variables, open loop",
    "clsrivc": "refined instrumental variables, closed loop",
}
"""What each estimator is called. Instruments come from the measured torque through the model, or from the
model under the log's own controller."""
