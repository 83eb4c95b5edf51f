"""flexdrill: the digital twin of a flexible drilling tool in an ultrashort-radius well.

    import flexdrill

    twin = flexdrill.Twin()                      # the paper's case; or a path, or nested mappings
    run = twin.run(20, speed_rpm=40, weight_kn=10)
    run.bit.torque_nm                            # an array over run.time_s
    calm, hard = twin.fork(), twin.fork()        # two futures of the same state
    calm.run(10, weight_kn=5)
    hard.run(10, weight_kn=30)

Inside everything is SI; names carry the unit: `_nm` is N m, `_rad_per_s` is rad/s. Inputs have the driller's units.
"""

from ._ahead import HoleAhead
from ._alarms import AlarmEvent
from ._bag import Bag, Band, Bands, Messages, read_bag
from ._errors import (
    ConfigError,
    FlexdrillError,
    InputError,
    NotRecordedError,
    Problem,
    RecordError,
    ResultFileError,
    SavedStateError,
    StartError,
    StepError,
    ValueOutOfBounds,
)
from ._groups import (
    Ageing,
    Applied,
    Bit,
    CodeArray,
    Contacts,
    CountArray,
    Energy,
    FloatArray,
    Hazards,
    Joints,
    Quality,
    Reactions,
    Shape,
    Solver,
    Transfer,
    Whirl,
)
from ._inputs import Input, Inputs, held
from ._life import VERDICTS, Damage, JointLife, Life, read_life
from ._map import Map, MapAxis, MapSample, read_map
from ._native import __version__
from ._results import BODIES, GROUPS, HAZARDS, HOLDERS, SEVERITIES, USUAL_GROUPS, WHIRL_KINDS, Recording, Snapshot
from ._results_file import PRIORITIES, QUANTILES, FlagArray, TextArray
from ._rollout import rollout
from ._sweep import Sweep, read_sweep
from ._twin import Config, Friction, Twin, shipped_configs

__all__ = [
    "BODIES",
    "GROUPS",
    "HAZARDS",
    "HOLDERS",
    "PRIORITIES",
    "QUANTILES",
    "SEVERITIES",
    "USUAL_GROUPS",
    "VERDICTS",
    "WHIRL_KINDS",
    "Ageing",
    "AlarmEvent",
    "Applied",
    "Bag",
    "Band",
    "Bands",
    "Bit",
    "CodeArray",
    "Config",
    "ConfigError",
    "Contacts",
    "CountArray",
    "Damage",
    "Energy",
    "FlagArray",
    "FlexdrillError",
    "FloatArray",
    "Friction",
    "Hazards",
    "HoleAhead",
    "Input",
    "InputError",
    "Inputs",
    "JointLife",
    "Joints",
    "Life",
    "Map",
    "MapAxis",
    "MapSample",
    "Messages",
    "NotRecordedError",
    "Problem",
    "Quality",
    "Reactions",
    "RecordError",
    "Recording",
    "ResultFileError",
    "SavedStateError",
    "Shape",
    "Snapshot",
    "Solver",
    "StartError",
    "StepError",
    "Sweep",
    "TextArray",
    "Transfer",
    "Twin",
    "ValueOutOfBounds",
    "Whirl",
    "__version__",
    "held",
    "read_bag",
    "read_life",
    "read_map",
    "read_sweep",
    "rollout",
    "shipped_configs",
]
