"""Say when a log decides between two hypotheses."""

UNDECIDED = 6.0
"""Difference of twice the log-likelihood, less penalties, below which neither is preferred. Source: Burnham &
Anderson, Model Selection (2002), ch. 2."""
