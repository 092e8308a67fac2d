"""Find what is wrong with a log but usable: in come its samples in one pass, out go `Defect`s.

A finder sees one stretch after another, keeps a bounded statistic, and states its defects at the end.
"""
