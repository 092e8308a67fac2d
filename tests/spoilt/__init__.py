"""Spoil the values of sound logs, and count the false causes."""
