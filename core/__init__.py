"""Hold the science: in come robots, logs and options, out go result documents; it knows nothing of HTTP."""
