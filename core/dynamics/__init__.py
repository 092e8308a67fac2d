"""Say what torque is made of: in comes a `RobotModel` and a choice of terms, out goes a `DynamicModel`, linear in its parameters."""
