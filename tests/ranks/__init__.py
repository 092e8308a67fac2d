"""Compare the number of base parameters with the numerical rank of another engine, on drawn URDFs."""
