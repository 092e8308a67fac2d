"""Hold a Kalman filter to what it expects of itself, and to batch least squares."""
