"""Take the rows of a data set joint by joint when a fit or a test first asks for them."""

from dataclasses import dataclass, field, replace

import numpy as np

from ...arrays import JointMask, JointSeries, Matrix
from ..dataset.dataset import Dataset
from ..regression.rows import JointRows, rows_of_joints


@dataclass(frozen=True, eq=False)
class FitRows:
    """Give the rows of every joint: those that are fitted, those that are held out, and all of them."""

    dataset: Dataset
    columns: tuple[Matrix, ...]
    """The model's base columns over all rows of the data set."""
    _taken: dict[str, tuple[JointRows, ...]] = field(default_factory=dict)

    @property
    def fitted(self) -> tuple[JointRows, ...]:
        """Give the rows that are fitted: usable, and not held out."""
        return self._take("fitted", self.dataset.usable & ~self.dataset.held_out[:, None])

    @property
    def held_out(self) -> tuple[JointRows, ...]:
        """Give the usable rows that are held out."""
        return self._take("held_out", self.dataset.usable & self.dataset.held_out[:, None])

    @property
    def everywhere(self) -> tuple[JointRows, ...]:
        """Give all rows."""
        return self._take("everywhere", np.ones_like(self.dataset.usable))

    def _take(self, name: str, mask: JointMask) -> tuple[JointRows, ...]:
        if name not in self._taken:
            self._taken[name] = rows_of_joints(self.dataset, self.columns, mask)
        return self._taken[name]

    def with_torque(self, torque: JointSeries) -> "FitRows":
        """Give the same rows of another torque."""
        taken = {
            name: tuple(replace(one, torque=torque[one.rows, joint]) for joint, one in enumerate(rows))
            for name, rows in self._taken.items()
        }
        return FitRows(replace(self.dataset, torque=torque), self.columns, taken)
