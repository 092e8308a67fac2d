"""Serve HTTP: connections come in, bounded and checked requests go on to the routes, responses go out."""
