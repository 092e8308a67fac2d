"""Estimate a robot that can exist.

In comes an `Observation` of base columns and a prior, out goes an `Estimate`.
"""
