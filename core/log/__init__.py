"""Hold what was measured: in comes a file and a mapping of its columns, out goes a `JointLog` in SI with its defects listed."""
