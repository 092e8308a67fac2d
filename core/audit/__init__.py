"""Audit a robot's description: bodies that cannot be, and entries that logs contradict."""
