"""Model the joint torque as a sum of terms that are linear in their parameters.

Input: a `RobotModel` and a choice of terms. Output: a `DynamicModel`. One file per effect is in `terms`.
"""
