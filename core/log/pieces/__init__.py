"""Choose the rows of a file that are its motion: rows as they stand come in, pieces on one clock go out."""
