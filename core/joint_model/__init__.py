"""Identify the continuous-time model of one joint: a log in which it moves alone comes in, models go out."""
