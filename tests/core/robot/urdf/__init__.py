"""Test core.robot.urdf."""
