"""Hold the laws of core.precision."""
