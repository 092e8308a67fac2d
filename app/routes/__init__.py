"""Answer requests: in comes HTTP, out goes HTTP; each file serves one resource and knows nothing of the others."""
