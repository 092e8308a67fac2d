"""Hold the laws of core.estimate."""
