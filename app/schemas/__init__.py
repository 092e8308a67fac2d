"""Declare requests and responses: JSON is validated by strict models, which also document it."""
