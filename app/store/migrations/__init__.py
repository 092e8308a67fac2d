"""Bring the database of an earlier version to the present layout: in comes an engine, out the tables."""
