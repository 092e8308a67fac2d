"""Read a file with a mapping into a `JointLog` in SI, with its defects listed."""
