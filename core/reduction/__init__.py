"""Find the identifiable parameters.

In comes a `DynamicModel`, out goes a `BaseModel` of base parameters and how the rest groups.
"""
