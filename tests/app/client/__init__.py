"""Hold the Python client to what it promises: typed results, errors with remedies, patience."""
