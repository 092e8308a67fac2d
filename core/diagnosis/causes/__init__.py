"""Candidate causes of simulation error, one file each, named like their torque term in `core/dynamics/terms`.

A term models the torque of an effect; its cause here states where it is searched, which estimates are
admissible, what they mean and how they are corrected. `registry` lists the causes, `imitation` and `masking`
relate them, `traits` is what the search has to know of them.
"""
