"""Receive request bodies: chunks come in, checked JSON, forms and files go out."""
