"""Hold the laws of conditioning: filters, derivatives, clocks and recipes."""
