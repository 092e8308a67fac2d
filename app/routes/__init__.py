"""Answer requests: in comes HTTP, out goes HTTP; one file per resource, none knows another."""
