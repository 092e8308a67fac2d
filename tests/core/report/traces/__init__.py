"""Traces are compared with what the study says of the same rows, and with all rows that they stand for."""
