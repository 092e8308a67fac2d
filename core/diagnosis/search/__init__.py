"""Search for causes: in come rows and candidate causes, out goes the `Selection` of a stepwise search."""
