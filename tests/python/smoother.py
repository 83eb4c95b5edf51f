"""One step of the ensemble smoother by iterative_ensemble_smoother, to hold ours against.

Reads JSON on standard input: the members x, their predictions y and standard normal perturbations e (rows of members), the
observations d, the covariance of their errors, and alpha. Prints the members after the step as JSON.
"""

import json
import sys

try:
    import numpy as np
    from iterative_ensemble_smoother import ESMDA
except ImportError as missing:
    print(missing)
    sys.exit(77)


def columns(rows):
    return np.array(rows, dtype=float).T.copy()


def main():
    given = json.load(sys.stdin)
    covariance = np.array(given["covariance"], dtype=float)
    # Of two steps with alpha = 2 the first; a single step has alpha = 1.
    steps = int(given["alpha"])
    smoother = ESMDA(covariance=covariance, observations=np.array(given["d"], dtype=float), alpha=steps, seed=1)
    perturbations = np.linalg.cholesky(covariance) @ columns(given["e"])
    smoother.prepare_assimilation(Y=columns(given["y"]), truncation=1.0, observation_perturbations=perturbations)
    print(json.dumps(smoother.assimilate_batch(X=columns(given["x"])).T.tolist()))


main()
