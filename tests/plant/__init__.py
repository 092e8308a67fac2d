"""A robot that hides an effect: a seed and a cause come in, a log and what its user believes go out."""
