"""Fit linear columns to torque under autoregressive noise: in come rows, out come fits and score tests."""
