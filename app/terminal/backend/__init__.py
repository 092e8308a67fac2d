"""Compute for the command line: a request comes in, a result goes out."""
