"""Compose the reader's page from a result document: the only place that formats numbers for it."""
