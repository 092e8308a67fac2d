"""Hold the laws of core.report."""
