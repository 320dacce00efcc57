"""The sheet as a membrane: two interfaces that share one pressure and the edges of contact."""
