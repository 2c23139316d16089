"""The second Sonine coefficient of a gas of smooth spheres."""


def sonine(epsilon: float) -> float:
    """Return a2 of the homogeneous cooling state (van Noije and Ernst 1998, d = 3)."""
    e = epsilon
    return 16.0 * (1.0 - e) * (1.0 - 2.0 * e**2) / (81.0 - 17.0 * e + 30.0 * e**2 * (1.0 - e))
