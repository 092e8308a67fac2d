"""Describe a residual: what it depends on, its noise floor, and which share of it is predictable.

In come a `Dataset`, the residual at its rows (measured minus predicted) and its noise model. Out go an
`Atlas` of the residual over every coordinate of the motion, a `NoiseFloor` that needs no model, and
`Predictable`: the share of the residual that an extension of the model could still explain.
"""
