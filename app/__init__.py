"""Offer the science over HTTP: in come robots, logs and jobs, out go result documents."""
