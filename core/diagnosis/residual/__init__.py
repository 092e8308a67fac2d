"""Lay a residual out: what it depends on, how low it could go, and how much of it is predictable at all.

In come a `Dataset`, the residual at its rows (measured minus predicted) and the noise learned from it. Out go
an `Atlas` of the residual over every coordinate of the motion, a `NoiseFloor` that needs no model, and
`Predictable`: the share of the residual that any model extension could still explain.
"""
