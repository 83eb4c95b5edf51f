"""A string that is pushed round an arc, by welleng's torque and drag (after SPE 11380), to hold the twin against.

Reads JSON on standard input: a list of cases with `friction`, `radius` (m), `weight_on_bit` (N), `weight` (N/m, in mud)
and `outer_diameter` (m), and the number of `stations`. Prints the version of welleng and, for each case, the force at
the kick-off (N) as the package computes it, and with the change of inclination counted from the bit upwards, as the
source has it. The package counts it downwards: in a hole that builds, the weight then presses to the wrong side.
"""

import json
import math
import sys
import warnings

if sys.version_info < (3, 11):
    print("welleng 0.30.0 is for Python 3.11 and later")
    sys.exit(78)
try:
    import numpy as np
    import welleng
    from welleng.architecture import BHA, WellBore
    from welleng.survey import Survey, SurveyHeader
    from welleng.torque_drag import TorqueDrag
except ImportError as missing:
    print(missing)
    sys.exit(77)


class Upwards(TorqueDrag):
    """With the sign of the source."""

    def get_inc_delta(self):
        super().get_inc_delta()
        self.inc_delta = -self.inc_delta


def force_at_kickoff(model, case, stations):
    # The string ends at a station, which the package finds by its depth: a length of whole millimetres.
    length = round(case["radius"] * math.pi / 2, 3)
    depth = np.linspace(0.0, length, stations + 1)
    inclination = np.linspace(0.0, 90.0, stations + 1)
    with warnings.catch_warnings():
        # It warns of an azimuth whose north it does not know; all are zero here.
        warnings.simplefilter("ignore")
        survey = Survey(
            md=depth, inc=inclination, azi=np.zeros(stations + 1), header=SurveyHeader(azi_reference="grid")
        )
        hole = WellBore("hole", top=0.0, bottom=length, method="top_down")
        hole.add_section(bottom=length, id=2.0 * case["outer_diameter"], coeff_friction_sliding=case["friction"])
        string = BHA("guide", top=0.0, bottom=length, method="top_down")
        string.add_section(bottom=length, od=case["outer_diameter"], unit_weight=case["weight"])
        # The weight is that in mud. The package wants a torque on the bit with a weight on the bit; it changes no force.
        computed = model(survey, hole, string, fluid_density=0.0, wob=case["weight_on_bit"], tob=1.0)
    return -float(computed.tension["sliding"][0])


def main():
    given = json.load(sys.stdin)
    cases, stations = given["cases"], given["stations"]
    results = [[force_at_kickoff(model, case, stations) for model in (TorqueDrag, Upwards)] for case in cases]
    print(json.dumps({"version": welleng.__version__, "results": results}))


main()
