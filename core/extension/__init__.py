"""Cure a model and measure the gain.

In come an identified model and a diagnosis; out go the model with the findings' terms, ready to be identified
again as one semidefinite programme, and what that gained on blocks that no fit has seen. Beside it go the
repairs, by which the robot's description or the log is mended itself.
"""
