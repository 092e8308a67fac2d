"""Simulate a controlled robot along a log, compiled, and differentiate what it does."""
