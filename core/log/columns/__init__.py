"""Tell what the columns of a table are: in comes a table, perhaps with a mapping, out go bound channels."""
