"""Recognise a robot's own controller in a log, and hold it as the simulation takes it."""
