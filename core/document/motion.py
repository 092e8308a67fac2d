"""Tabulate the errors of simulated motion."""

from ..simulation.multistep import MultiStep


def position_errors(found: MultiStep) -> dict[str, object]:
    """Tabulate errors by horizon (rows) and joint (columns); `steady_rms` is that of keeping the velocity."""
    return {
        "horizons_s": found.horizons,
        "windows": len(found.keys),
        "position_rms": found.position_rms,
        "velocity_rms": found.velocity_rms,
        "steady_rms": found.still_rms,
    }
