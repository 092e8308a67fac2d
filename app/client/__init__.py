"""Use a service from Python: a log and a robot go in, typed results with arrays and data frames come out.

``from veritorque import Client`` is all that a notebook needs; the terminal's `--url` is made of it.
"""
