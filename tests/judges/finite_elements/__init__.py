"""Steady rolling of coated rollers by finite elements at finite strain; nothing of rollnip."""
