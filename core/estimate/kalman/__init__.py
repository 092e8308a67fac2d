"""Fit by a Kalman filter: where it begins, what it takes in, and the equations that it leaves."""
