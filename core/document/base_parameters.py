"""Write the base parameters that a robot's structure allows, which no log has to show."""

from ..dynamics.model import standard_model
from ..reduction.base import base_model
from ..robot.model import RobotModel
from .identification import grouping_row
from .numbers import plain


def base_parameters(robot: RobotModel) -> dict[str, object]:
    """Give the base parameters with their groupings."""
    base = base_model(standard_model(robot))
    rows = [grouping_row(base, row) for row in range(len(base.kept))]
    counts = {"standard": len(base.model.parameters), "base": len(base.kept)}
    without = [base.model.parameters[column].name for column in base.without_effect]
    document = {"counts": counts, "rank": base.rank, "base_parameters": rows, "without_effect": without}
    return {key: plain(value) for key, value in document.items()}
