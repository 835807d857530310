"""One change at one level: an old world for five half-lives, then the new one; and what is measured of it."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from benchmarks.paper.definitions import Definition
from benchmarks.paper.metrics import Change, delay, error, flicker, half_and_half, shows_new
from benchmarks.paper.rivals import Rival
from benchmarks.paper.watched import EVERY, Watched, drawn, old_history
from sample_logs.rays import Floats
from timemap_cli.model.levels import Level
from timemap_cli.model.virtual_scan import Ranges


@dataclass(frozen=True, slots=True)
class Outcome:
    """What one definition made of one change; means over nodes."""

    delay: float  # [scans] until 90 % of the changed angle bins show it; NaN where a node never does
    slowest: float  # [scans]
    mixed: float  # [scans] for which a node shows a changed run half old, half new
    error: float  # [m] at the end
    flicker: float  # share of the steps of an angle bin outside the change that jump
    share: Floats  # (estimates,) of the changed angle bins that show the new state


@dataclass(frozen=True, slots=True)
class Trial:
    """Scans of a world before and after a change, from which each node draws its own."""

    before: Ranges  # (scans, angle_bins) [mm]
    after: Ranges
    change: Change

    def estimates(
        self,
        level: Level,
        nodes: int,
        random: np.random.Generator,
        definitions: Mapping[str, Definition],
        rivals: Mapping[str, Rival] | None = None,
        *,
        half_lives: float = 3.0,
    ) -> dict[str, Floats]:
        """Estimates (k, nodes, angle_bins) [m] of each definition, every ten scans after the change."""
        watched = Watched(level, nodes, definitions, rivals)
        watched.learn(drawn(self.before, old_history(level), nodes, random))
        return watched.follow(drawn(self.after, round(half_lives * level.half_life), nodes, random))

    def outcome(self, seen: Floats) -> Outcome:
        """What is measured of one definition's estimates."""
        delays = delay(seen, self.change, EVERY)
        return Outcome(
            float(delays.mean()),
            float(delays.max()),
            float(half_and_half(seen, self.change).sum(axis=0).mean() * EVERY),
            float(error(seen[-1], self.change.new, self.change.even).mean()),
            flicker(seen, self.change.even & ~self.change.changed),
            shows_new(seen, self.change)[..., self.change.changed].mean(axis=(1, 2)),
        )
