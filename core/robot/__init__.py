"""Describe what is believed before measuring: in comes an MDH table or a URDF, out goes a `RobotModel`."""
