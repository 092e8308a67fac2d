"""The effects beside the standard model, held against exact solutions and the laws they stand for."""
