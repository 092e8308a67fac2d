"""Hold estimates by Kalman filters to batch estimates, and to parameters that drift."""
