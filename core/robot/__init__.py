"""Read a modified DH table or a URDF into a `RobotModel`, and write it again."""
