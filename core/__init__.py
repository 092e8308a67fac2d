"""Identify the dynamics of a robot from its log: a robot that can physically exist, and how well each number is known."""
