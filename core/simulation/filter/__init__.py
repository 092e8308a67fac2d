"""Carry a Kalman filter of state and parameters through the samples of a log, compiled."""
