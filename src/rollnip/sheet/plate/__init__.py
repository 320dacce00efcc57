"""A sheet that resists bending: two interfaces, each with pressure, shear and edges of its own."""
