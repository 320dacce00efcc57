"""Output of a solution: its case, its tree of values, its dataset and its summary.

These modules only read attributes of a solution, so that `Solution` itself can build on them.
"""
