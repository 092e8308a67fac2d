"""Say what reading a file may cost: a little in any case, and more the longer the file is.

A file that asks for much more than its bytes justify is made to hurt: it unpacks to a multiple of its size,
or makes its reader turn in circles. What a sound file needs is a fraction of these figures.
"""

from dataclasses import dataclass

MEGABYTE = 1024**2


@dataclass(frozen=True)
class Budget:
    """Bound what one process may use."""

    processor_s: float
    """Processor time, s, which does not depend on what else the machine does."""
    wall_s: float
    """Time by the clock, s; it is there for processes that wait forever."""
    memory_bytes: int
    """Memory beyond what the loaded libraries take."""


def budget_for(size: int) -> Budget:
    """Give the budget of reading a file of so many bytes.

    Examples
    --------
    >>> budget_for(0).processor_s, budget_for(20 * MEGABYTE).processor_s
    (1.0, 4.0)
    """
    processor_s = 1.0 + 0.15 * size / MEGABYTE
    return Budget(processor_s, 120.0 + 10.0 * processor_s, 160 * MEGABYTE + 6 * size)
