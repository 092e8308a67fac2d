"""Simulate one YuMi arm with an engine that is not ours, and identify it through the HTTP service.

In: the arm's geometry, link bodies, drives and sensors. Out: `log.csv`, what a robot controller would have
recorded; `truth.json`, what the identification should find; `robot.json`, what the service is told about the
robot.
"""
