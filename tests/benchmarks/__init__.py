"""Hold the benchmarks to running at all: in comes a tiny scene, out goes a table of figures."""
