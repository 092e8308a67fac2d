"""Run computations: a computation and its local files go in, its outcome comes out."""
