"""Extend a model by the causes found, and measure the gain.

In come an identified model and a diagnosis. Out go the model with the findings' terms, identified again as
one semidefinite programme, its gain on held-out blocks, and the corrections of the description or the log.
"""
