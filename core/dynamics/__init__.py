"""Say what torque is made of.

In comes a `RobotModel` and a choice of terms, out goes a `DynamicModel`, linear in its parameters.
"""
