"""The two-sample test of Kolmogorov and Smirnov: could both samples come of one distribution?"""

import bisect
import math


def distance(first, second):
    """The largest difference between the two empirical distribution functions."""
    first, second = sorted(first), sorted(second)
    return max(abs(bisect.bisect_right(first, x) / len(first) -
                   bisect.bisect_right(second, x) / len(second))
               for x in {*first, *second})


def probability(d, first_size, second_size):
    """That two samples of one continuous distribution lie at least `d` apart; more for one with
    steps, so that small values speak against it all the more.

    Q(lambda) = 2 sum_k (-1)^(k-1) exp(-2 k^2 lambda^2), lambda = d (sqrt(n) + 0.12 + 0.11/sqrt(n)),
    n = n1 n2 / (n1 + n2).
    Source: M. A. Stephens, "Use of the Kolmogorov-Smirnov, Cramer-von Mises and related statistics
    without extensive tables", J. R. Stat. Soc. B 32 (1970), pp. 115-122. Range: n of 4 and more.
    """
    size = math.sqrt(first_size * second_size / (first_size + second_size))
    scaled = d * (size + 0.12 + 0.11 / size)
    if scaled < 0.2:
        return 1.0  # to 12 digits, where the series converges slowly
    terms = (2 * (-1)**(k - 1) * math.exp(-2 * k**2 * scaled**2) for k in range(1, 101))
    return min(1.0, max(0.0, sum(terms)))
