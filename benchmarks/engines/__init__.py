"""What other engines do to a bouncing dumbbell, against the exact solution; docs/performance.md."""
