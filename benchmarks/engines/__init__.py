"""A bouncing dumbbell in other engines, against the exact solution; docs/performance.md."""
