"""The values of a WITS frame as witskit reads them, to hold ours against.

Reads a frame on standard input. Prints a list of item code, description, value, and unit in metric and in field units, as
JSON.
"""

import json
import sys

try:
    from loguru import logger
    from witskit import WITSDecoder
except ImportError as missing:
    print(missing)
    sys.exit(77)


def main():
    # It logs every item.
    logger.remove()
    raw = sys.stdin.read()
    metric, field = (
        WITSDecoder(use_metric_units=metric, strict_mode=True).decode_frame(raw).data_points for metric in (True, False)
    )
    print(
        json.dumps(
            [
                [ours.symbol.code, ours.symbol.description, ours.parsed_value, ours.unit, theirs.unit]
                for ours, theirs in zip(metric, field)
            ]
        )
    )


main()
