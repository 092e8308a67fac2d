"""Torque terms, one file per effect, each linear in its parameters.

The standard model has `rigid_body`, `rotor_inertia`, `viscous`, `coulomb`, `offset` and `coupling`. A file
that is named like a cause of `core/diagnosis/causes` models the effect of that candidate.
"""
