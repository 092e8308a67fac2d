"""Write the model as linear equations.

In comes a `DynamicModel` and `Motion`s, out goes an `Observation` of small factors.
"""
