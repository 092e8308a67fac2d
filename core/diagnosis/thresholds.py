"""Hold every number that decides an answer of the diagnosis, each once."""

UNDECIDED = 6.0
"""Two hypotheses whose criteria differ by less are undecided.

Source: Burnham & Anderson, Model Selection (2002), ch. 2.
"""
