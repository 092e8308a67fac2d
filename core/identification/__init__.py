"""Identify a robot: in come logs, a model and options, out goes an `Identification` with its warnings."""
