"""The sheet as a plate: two interfaces, each with its own pressure, shear and edges of contact."""
