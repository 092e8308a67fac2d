"""Ask whether it predicts the unseen.

In comes an estimate and held-out equations, out come scores and certificates.
"""
