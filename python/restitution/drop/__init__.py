"""Bodies dropped on a plane: the run, its release, simulation, records and statistics."""
