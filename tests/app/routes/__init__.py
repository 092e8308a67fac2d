"""Hold the resources of the service to their contract, by requests."""
