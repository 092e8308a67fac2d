"""Audit a robot's description: impossible bodies, and entries that logs contradict."""
