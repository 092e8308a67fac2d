"""Hold the simulation to other engines and to mechanics: in come random robots, out goes agreement."""
