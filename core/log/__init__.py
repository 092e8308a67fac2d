"""Hold what was measured.

In comes a file and a mapping, out goes a `JointLog` in SI with its defects listed.
"""
