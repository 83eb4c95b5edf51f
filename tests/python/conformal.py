"""Split conformal prediction over groups.

conformal.py

Run as a program it compares `quantile` with populations whose quantiles are known in closed form, and ends with 1 where
they disagree.
"""

import math
import random
import sys
from statistics import NormalDist


def quantile(groups, holds):
    """The score below which a share `holds` of a new group's scores lies, or None of too few groups.

    `groups` has the scores of each. Each of K groups has the weight 1 / (K + 1), shared by its scores, and the group to
    come has 1 / (K + 1) at infinity (Lee, Barber and Willett, Distribution-free inference with hierarchical data, 2023). A
    score of a new group that is exchangeable with the others is within with a probability of at least `holds`; the scores
    of a group need not be independent. Below holds / (1 - holds) groups there is none.
    """
    groups = [scores for scores in groups if scores]
    weighed = sorted((score, 1 / (len(groups) + 1) / len(scores)) for scores in groups for score in scores)
    cumulated = 0.0
    for score, weight in weighed:
        cumulated += weight
        # Rounding must not cost the last score.
        if cumulated >= holds - 1e-9:
            return score if math.isfinite(score) else None
    return None


def population(rng, groups, spread, scores):
    """Absolute values of normal scores about a middle per group, whose deviation is `spread`."""
    middles = [rng.gauss(0, spread) for _ in range(groups)]
    return [[abs(rng.gauss(middle, 1)) for _ in range(scores)] for middle in middles]


def main():
    rng = random.Random(3)
    # Within all groups together the scores are |N(0, 1 + spread^2)|.
    for spread in (0.0, 0.5, 3.0):
        known = NormalDist(0, math.hypot(1, spread)).inv_cdf(0.95)
        found = quantile(population(rng, 4000, spread, 5), 0.9)
        # 4000 groups know a quantile of 90 % of a normal distribution's size to 1.5 %: four of these.
        assert abs(found / known - 1) < 0.06, (spread, found, known)
    # Few groups: the share that a new group has within lies between 0.9 and 0.9 + 1 / (K + 1) and a step of the quantile.
    for count in (9, 15, 30):
        shares = []
        for _ in range(400):
            bound = quantile(population(rng, count, 2.0, 20), 0.9)
            [new] = population(rng, 1, 2.0, 20)
            shares.append(sum(score <= bound for score in new) / len(new))
        mean = sum(shares) / len(shares)
        # The share of a group scatters by 0.25: 0.0125 of the mean of 400. Three of these.
        assert 0.9 - 0.0375 < mean < 0.9 + 2 / (count + 1) + 0.0375, (count, mean)
    assert quantile(population(rng, 8, 1.0, 20), 0.9) is None
    assert quantile([[1.0]] * 8 + [[math.inf]], 0.9) is None
    assert quantile([[], [2.0], *[[1.0]] * 18], 0.9) == 1.0
    # A long group counts as one.
    assert quantile([[5.0] * 1000, *[[1.0]] * 29], 0.9) == 1.0
    return 0


if __name__ == "__main__":
    sys.exit(main())
