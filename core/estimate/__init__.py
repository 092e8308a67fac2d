"""Estimate a physically consistent robot.

In comes an `Observation` of base columns and a prior, out goes an `Estimate`.
"""
