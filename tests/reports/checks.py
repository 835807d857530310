"""Cases of checks: one that failed, one that passed, one without a verdict."""

from timemap_cli.checks.verdict import CheckedCase, Measure, Spot, Verdict
from timemap_cli.errors import UsageError

SPOT = Spot(1.5, 2.25, "70 ends off by 0.15 m, seen from nodes 4, 5", (4, 5))
PLACES = Measure("ranges.places", "long", 1.0, 0.0, "places", "surfaces moved at 1 place", (SPOT,))
MOVED = Measure("ranges.moved", "long", 0.04, 0.03, "", "4.00 % of 100 angle bins moved")
SCANS = Measure("scans.read", None, 0.0, 0.005, "", "10 scans read, 10 expected")


def verdict(name, *measures, causes=(), notes=(), unequal=None):
    return Verdict(name, f"{name}.yaml", measures, causes, notes, unequal)


FAILED = CheckedCase(
    "hall",
    "hall.yaml",
    verdict("hall", SCANS, MOVED, PLACES, causes=("something moved: 50 %, <here>",), notes=("a note",)),
)
PASSED = CheckedCase("yard", "yard.yaml", verdict("yard", SCANS))
ERROR = CheckedCase("roof", "roof.yaml", None, UsageError("there is no file roof.yaml", hint="look again"))
LOST = CheckedCase("dock", "dock.yaml", verdict("dock", SCANS), lost=True, warnings=("dock.bag is cut off",))
UNEQUAL = CheckedCase("gate", "gate.yaml", verdict("gate", SCANS, unequal=("the change events",)))
