"""The model calculated again, by other means, to compare the engine with.

`multiprecision` follows the paper literally in three dimensions with fifty digits; `initial_value` knows
only the Newton-Euler equations and a general integrator. Neither shares a line or a closed form with the
engine, nor with the other.
"""
