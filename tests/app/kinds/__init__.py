"""Run jobs of every kind through the service."""
