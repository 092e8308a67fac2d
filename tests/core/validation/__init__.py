"""Hold the laws of core.validation."""
