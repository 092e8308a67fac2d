"""Ask how well an estimate predicts held-out data.

In comes an estimate and held-out equations, out come scores and certificates.
"""
