"""What a replay of some recordings would be short of, in sentences."""

from collections.abc import Mapping, Sequence
from itertools import pairwise

from timemap_cli.config import Settings
from timemap_cli.logs.beams import Beams
from timemap_cli.logs.interleave import joined
from timemap_cli.logs.poses import TF
from timemap_cli.logs.recordings import Recording
from timemap_cli.logs.sampled_poses import SampledPoses
from timemap_cli.logs.sampling import Sample
from timemap_cli.logs.scan_window import WINDOW_NS
from timemap_cli.logs.selection import (
    Seen,
    Selection,
)


def _unlike(recordings: Sequence[Recording], sample: Sample) -> list[str]:
    """A sentence for every group of recordings that are of one time and yet not of one drive."""
    found = []
    for group in joined(recordings, WINDOW_NS):
        apart = [drive for drive in sample.drives if drive[0] in group]
        if len(apart) > 1:
            names = " and ".join(", ".join(str(recordings[index].path) for index in drive) for drive in apart)
            found.append(
                f"{names} hold other poses for the same times, as of two robots or two simulations: "
                "they are read one after the other"
            )
    return found


def shortcomings(
    recordings: Sequence[Recording], sample: Sample, poses: SampledPoses, selection: Selection
) -> tuple[str, ...]:
    """What a replay of the recordings would be short of."""
    found = _unlike(recordings, sample)
    for index, recording in enumerate(recordings):
        topics = [topic for topic in selection.scan_topics if (index, topic) in sample.scans]
        if not topics:
            found.append(f"{recording.path} has no scans of {', '.join(selection.scan_topics)}")
        posed = [topic for topic in topics if poses.are_known(index, topic, selection)]
        found += [
            f"{recording.path} has no poses in '{selection.map_frame}' for {topic}"
            for topic in topics
            if topic not in posed
        ]
    return tuple(found)


def carried(seen: Seen, sample: Sample, selection: Selection) -> tuple[str, ...]:
    """A sentence for every laser that cannot move in the map frame, because the robot carries both."""
    if selection.pose != TF or not seen.frames.roots_of(selection.map_frame):
        return ()
    fixed = {frozenset((batch.parent, batch.child)) for batch in sample.static.all}
    lasers = dict.fromkeys(
        frame for topic in selection.scan_topics for frame in seen.scan_frames.get(topic, ())
    )
    chains = {laser: seen.frames.path(selection.map_frame, laser) for laser in lasers}
    return tuple(
        f"'{laser}' never moves in '{selection.map_frame}': that frame moves with the robot, and so would the map"
        for laser, chain in chains.items()
        if all(frozenset(pair) in fixed for pair in pairwise(chain))
    )


def short_sighted(beams: Mapping[tuple[int, str], Beams], settings: Settings) -> tuple[str, ...]:
    """A sentence for every scanner whose missing returns free less than a node looks at from its place."""
    wanted = settings.map.radius + settings.map.node_spacing / 2
    clear = {topic: one for (_, topic), one in beams.items() if one.missing_is_clear}
    reach = {topic: one.clear_range for topic, one in clear.items() if one.clear_range < wanted}
    return tuple(
        f"{topic} reaches {metres:g} m and nodes look {settings.map.radius:g} m: little or nothing is seen clear; "
        f"set map.radius to {max(0.5, metres - settings.map.node_spacing):g} (see timemap config)"
        for topic, metres in reach.items()
    )
