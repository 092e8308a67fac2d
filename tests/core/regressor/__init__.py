"""Hold the laws of the equations: kernel against engines, factors as a monoid, streams against matrices."""
