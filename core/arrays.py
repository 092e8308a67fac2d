"""Name the axes of every array, so that a signature says what a comment would.

The aliases are checked at run time in the tests (jaxtyping with beartype) and cost nothing in production,
where nobody has loaded jaxtyping, which takes as long to load as NumPy.
"""

import sys
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING or "jaxtyping" in sys.modules:
    from jaxtyping import Bool, Complex, Float, Int
else:

    class _Unchecked:
        """Stand for arrays whose axes are named, but not checked."""

        def __class_getitem__(cls, named: tuple[type, str]) -> type:
            """Give the array's type."""
            return named[0]

    Bool = Complex = Float = Int = _Unchecked

# "samples" are instants as measured, "instants" those a computation asks for or leaves.
Samples = Float[np.ndarray, " samples"]
Instants = Float[np.ndarray, " instants"]
InstantSeries = Float[np.ndarray, "instants joints"]
SampleMask = Bool[np.ndarray, " samples"]
JointSeries = Float[np.ndarray, "samples joints"]
Beside = Float[np.ndarray, "samples joints 2"]
FrictionShares = Float[np.ndarray, "samples frictions"]
JointMarks = Bool[np.ndarray, " joints"]
JointMask = Bool[np.ndarray, "samples joints"]
InstantMask = Bool[np.ndarray, "instants joints"]
JointVector = Float[np.ndarray, " joints"]
Vector3 = Float[np.ndarray, "3"]
Vector = Float[np.ndarray, " values"]
Rotation = Float[np.ndarray, "3 3"]
PseudoInertia = Float[np.ndarray, "4 4"]
LinkParameters = Float[np.ndarray, "10"]
RowSeries = Float[np.ndarray, "rows joints"]
Jacobian = Float[np.ndarray, "samples 6 joints"]
LinkTable = Float[np.ndarray, "links 10"]
Parameters = Float[np.ndarray, " parameters"]
BaseParameters = Float[np.ndarray, " base"]
Matrix = Float[np.ndarray, "rows columns"]
Rows = Float[np.ndarray, "_ columns"]
Weights = Float[np.ndarray, " _"]
EquationRows = Float[np.ndarray, "_ _"]
Mask = Bool[np.ndarray, " _"]
IncrementMask = Bool[np.ndarray, " increments"]
MarkTable = Bool[np.ndarray, "rows columns"]
UsableRows = Bool[np.ndarray, " _"]
Intervals = Float[np.ndarray, "columns 2"]
SquareMatrix = Float[np.ndarray, "size size"]
Series = Float[np.ndarray, "entries samples"]
KeptSeries = Float[np.ndarray, "entries instants"]
Spectrum = Complex[np.ndarray, " _"]
Indices = Int[np.ndarray, " _"]
Runs = Int[np.ndarray, "runs 2"]
BlockDraws = Int[np.ndarray, "draws blocks"]
BlockKey = tuple[int, int]
"""Number of a log and of one of its blocks, both from 0."""
