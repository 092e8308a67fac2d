"""A robot that hides an effect: a seed, a cause and a strength come in, a log and what its user believes go out."""
