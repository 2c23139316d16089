"""Bouncing-ball experiments: times, recordings, error budgets, inference."""
