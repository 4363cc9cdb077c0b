"""Closed forms that the plots compare with."""

import math

LIGHT_MPS = 299_792_458.0
CARRIER_HZ = 2.437e9
WAVELENGTH_M = LIGHT_MPS / CARRIER_HZ


def free_space_db(distance_m):
    """Friis 1946, Recommendation ITU-R P.525."""
    return 20 * math.log10(4 * math.pi * distance_m / WAVELENGTH_M)


def knife_edge_db(nu):
    """Recommendation ITU-R P.526, single knife-edge obstacle."""
    if nu <= -0.78:
        return 0.0
    return 6.9 + 20 * math.log10(math.hypot(nu - 0.1, 1) + nu - 0.1)


def fresnel_parameter(height_m, first_m, second_m):
    """nu of an edge `height_m` above the ray, at these distances from its ends."""
    return height_m * math.sqrt(2 / WAVELENGTH_M * (1 / first_m + 1 / second_m))


def rice_probability_below(power, k):
    """Of the power of mean 1: a mixture of Gamma distributions, weighted by Poisson's."""
    scaled = (k + 1) * power
    total, weight, below, term = 0.0, math.exp(-k), 1 - math.exp(-scaled), math.exp(-scaled)
    for order in range(200):
        total += weight * below
        weight *= k / (order + 1)
        term *= scaled / (order + 1)
        below -= term
    return total


def bessel_j0(x):
    """Bessel's integral, by the midpoint rule."""
    steps = 100
    return sum(math.cos(x * math.sin(math.pi * (i + 0.5) / steps)) for i in range(steps)) / steps


def crossings_per_wavelength(rho):
    """Upward, of a Rayleigh envelope through rho times its root mean square (Jakes 1974, 1.3-35)."""
    return math.sqrt(2 * math.pi) * rho * math.exp(-rho**2)


def dipole_dbi(elevation_deg):
    """Balanis, "Antenna Theory", 4.6, upright."""
    sine = math.cos(math.radians(elevation_deg))
    return 20 * math.log10(math.cos(math.pi / 2 * math.sin(math.radians(elevation_deg))) / sine) \
        + 10 * math.log10(1.64092)


WINDOWS = [16 * 2**stage for stage in range(7)]  # CW 15 ... 1023, seven attempts


def collision_probability(stations):
    """G. Bianchi, IEEE J. Sel. Areas Commun. 18(3), 2000, with seven attempts: p and tau."""
    low, high = 0.0, 1.0
    for _ in range(60):
        p = (low + high) / 2
        attempts = sum(p**stage for stage in range(7))
        slots = sum(p**stage * (1 + (window - 1) / 2) for stage, window in enumerate(WINDOWS))
        tau = attempts / slots
        low, high = (p, high) if 1 - (1 - tau)**(stations - 1) > p else (low, p)
    return p, tau


def saturation_mbps(stations, ip_bytes, data_us, ack_us, slot_us, sifs_us=10, longest_ack_us=50):
    """The same, goodput of IP packets; after a collision EIFS."""
    _, tau = collision_probability(stations)
    difs_us = sifs_us + 2 * slot_us
    idle = (1 - tau)**stations
    success = stations * tau * (1 - tau)**(stations - 1)
    mean_us = (idle * slot_us + success * (data_us + sifs_us + ack_us + difs_us)
               + (1 - idle - success) * (data_us + sifs_us + longest_ack_us + difs_us))
    return success * 8 * ip_bytes / mean_us
