"""Turn data into the equations that are solved, by one file per estimator."""
