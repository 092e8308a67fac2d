"""Make the identified robot move.

In come a `DynamicModel` with its standard parameters and a `Motion`; out go the torque and the motion that
the model predicts, beside the measured ones.
"""
