"""Compose the reader's page: in come all chapters' results, out goes the result document.

The only place that formats numbers.
"""
