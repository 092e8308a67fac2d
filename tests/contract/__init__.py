"""Contracts on the code's shape: who imports whom, sizes, docstrings, locks, vendored files, the API document."""
