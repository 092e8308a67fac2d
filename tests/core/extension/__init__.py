"""Hold the laws of core.extension."""
