"""Prepare the data set of a diagnosis: in come logs and a bandwidth, out go filtered rows in segments."""
