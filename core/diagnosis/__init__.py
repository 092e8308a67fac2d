"""Name what a simulation gets wrong.

In come an identification and its logs; out goes a `Diagnosis`: causes with their evidence, the rivals that
were refuted or could not be told apart, and how much stays unexplained. `dataset` prepares the equations,
`noise` whitens them, `score` judges candidates, `causes` holds one file per cause, `verdict` decides.
"""
