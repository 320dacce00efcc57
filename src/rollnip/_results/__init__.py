"""Output of a solution: its case, its tree of values, its dataset, its summary.

These read the attributes of a solution alone, so that `Solution` can stand on them.
"""
