"""Tell how well each number is known: in come an `Observation` and an estimate, out goes an `Inference`."""
