"""Rates of a dilute gas by kinetic theory, where all velocities and spins have Maxwell's distributions."""

from restitution.gas.theory._rates import Rates, cooling, haff_time, rates, steady_ratio

__all__ = ["Rates", "cooling", "haff_time", "rates", "steady_ratio"]
