"""Rolling contact of cylinders coated with layered, viscoelastic rubber."""
