"""Poses of the laser as far as a sample of the recordings goes."""

from timemap_cli.logs.drives import Drive
from timemap_cli.logs.poses import PoseSource
from timemap_cli.logs.sampling import Sample
from timemap_cli.logs.selection import (
    PoseChoice,
    Selection,
)


class SampledPoses:
    """Poses of the recordings as far as a sample goes."""

    def __init__(self, sample: Sample) -> None:
        self._sample = sample
        self._sources: dict[tuple[Drive, str, str], PoseSource] = {}

    def source(self, index: int, map_frame: str, pose: str, *, alone: bool = False) -> PoseSource:
        """Poses of the drive that a recording belongs to, or those that the recording holds `alone`."""
        (drive,) = (drive for drive in self._sample.drives if index in drive)
        return self._source((index,) if alone else drive, map_frame, pose)

    def _source(self, group: Drive, map_frame: str, pose: str) -> PoseSource:
        key = group, map_frame, pose
        if key not in self._sources:
            source = self._sources[key] = PoseSource(map_frame, pose)
            for transforms in self._sample.static.of_drive(group):
                source.add(transforms)
            for transforms in (batch for index in group for batch in self._sample.transforms[index]):
                source.add(transforms)
            for poses in (batch for index in group for batch in self._sample.poses[index]):
                source.add(poses)
        return self._sources[key]

    def are_known(self, index: int, topic: str, choice: PoseChoice | Selection) -> bool:
        """Whether a choice gives poses to scans of a topic in a recording."""
        source = self.source(index, choice.map_frame, choice.pose)
        scans = self._sample.scans.get((index, topic), ())
        return any(bool(source.lookup(batch.frame_id, batch.stamps_ns)[1].any()) for batch in scans)

    def are_known_somewhere(self, topic: str, choice: PoseChoice) -> bool:
        """Whether a choice gives poses to scans of a topic in any recording."""
        return any(
            self.are_known(index, topic, choice) for index, name in self._sample.scans if name == topic
        )
