"""Read a URDF: in come the bytes of a file, out goes a `RobotModel`."""
