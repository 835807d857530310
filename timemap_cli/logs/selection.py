"""Which scan topics, map frame and poses a replay uses, and what to say where that is not clear."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches

from timemap_cli.config import InputSettings
from timemap_cli.errors import UsageError, as_word
from timemap_cli.logs.frames import Frames
from timemap_cli.logs.hints import family, instead, what_else, what_to_record
from timemap_cli.logs.poses import TF

SCAN_TYPE = "sensor_msgs/msg/LaserScan"
POSE_TYPES = (
    "geometry_msgs/msg/PoseWithCovarianceStamped",
    "geometry_msgs/msg/PoseStamped",
    "nav_msgs/msg/Odometry",
)
WITH_COVARIANCE = (POSE_TYPES[0], POSE_TYPES[2])
DEFAULT_MAP_FRAME = "map"
# Poses that somebody wants or guesses, not poses of the robot.
WISHES = ("goal", "initial", "target", "waypoint", "set_pose", "clicked")
# Words in the names of topics on which localisers tell what they send as transforms: amcl, emcl, slam_toolbox.
LOCALISERS = ("mcl", "localiz", "localis", "slam")


@dataclass(frozen=True, slots=True)
class Selection:
    """What a replay reads."""

    scan_topics: tuple[str, ...]
    map_frame: str
    pose: str  # "tf" or the topic of the poses
    warnings: tuple[str, ...] = ()
    covariances: str | None = None  # the topic that tells how uncertain the poses are

    @property
    def pose_topics(self) -> tuple[str, ...]:
        """The topics of poses to read."""
        topics = (self.pose if self.pose != TF else None, self.covariances)
        return tuple(dict.fromkeys(topic for topic in topics if topic))


@dataclass(frozen=True, slots=True)
class PoseTopic:
    """A topic with poses, as a look at the recordings found it."""

    topic: str
    msgtype: str
    frame_id: str
    child_frame_id: str | None
    count: int


@dataclass(frozen=True, slots=True)
class Seen:
    """What a look at the recordings found."""

    logs: tuple[str, ...]  # the recordings as the user named them
    topics: Mapping[str, str]  # topic -> message type
    scan_frames: Mapping[str, tuple[str, ...]]  # scan topic -> frames of its scans
    frames: Frames
    poses: tuple[PoseTopic, ...]

    def line(self, *options: str) -> str:
        """A command to paste."""
        logs = " ".join(self.logs) if len(self.logs) <= 3 else f"{self.logs[0]} ..."
        return f"timemap replay {logs} {' '.join(map(as_word, options))}"


@dataclass(frozen=True, slots=True)
class PoseChoice:
    """A map frame and where the poses in it come from."""

    map_frame: str
    pose: str
    warnings: tuple[str, ...] = ()
    covariances: str | None = None


def scan_candidates(logs: Sequence[str], topics: Mapping[str, str], wanted: Sequence[str]) -> tuple[str, ...]:
    """The scan topics that come into question, sorted by name; those the user named, if any.

    UsageError where there is none, or where a topic that was named is not one.
    """
    scans = tuple(sorted(topic for topic, msgtype in topics.items() if msgtype == SCAN_TYPE))
    where = ", ".join(logs) if len(logs) <= 3 else f"{len(logs)} recordings"
    if not scans:
        raise UsageError(f"no laser scans in {where}: {what_else(topics, SCAN_TYPE)}", hint=instead(topics))
    for topic in wanted:
        if topic not in topics:
            near = get_close_matches(topic, scans, 1) or scans
            raise UsageError(
                f"no topic {topic} in {where}",
                hint="\n".join(f"--scan-topic {as_word(name)}" for name in near),
            )
        if topic not in scans:
            raise UsageError(
                f"{topic} holds {topics[topic]}, not {SCAN_TYPE}",
                hint="\n".join(f"--scan-topic {as_word(name)}" for name in scans),
            )
    return tuple(dict.fromkeys(wanted)) or scans


def select(
    seen: Seen, candidates: Sequence[str], wanted: InputSettings, works: Callable[[str, PoseChoice], bool]
) -> Selection:
    """Choose by what the recordings hold, where there is one choice.

    `works` says whether a pose choice gives poses for scans of a topic. UsageError lists lines to paste.
    """
    if wanted.scan_topics or len(candidates) == 1:
        scans = tuple(candidates)
        choice = choose_poses(seen, scans, wanted, works)
        return Selection(scans, choice.map_frame, choice.pose, choice.warnings, choice.covariances)
    tried = {topic: _try_poses(seen, topic, wanted, works) for topic in candidates}
    found = {topic: choice for topic, choice in tried.items() if choice is not None}
    if len(found) != 1:
        lines = [seen.line("--scan-topic", topic) for topic in (found or candidates)]
        if found:  # the lasers of one robot
            first, *rest = found
            lines.append(
                " ".join(
                    (seen.line("--scan-topic", first), *(f"--scan-topic {as_word(one)}" for one in rest))
                )
            )
        raise UsageError(
            f"{len(candidates)} scan topics and none named: {', '.join(candidates)}", hint="\n".join(lines)
        )
    ((topic, choice),) = found.items()
    others = ", ".join(name for name in candidates if name != topic)
    warning = f"using {topic}, the only scan topic with poses (not {others})"
    warnings = (warning, *choice.warnings)
    return Selection((topic,), choice.map_frame, choice.pose, warnings, choice.covariances)


def gone_on_with(earlier: Selection, seen: Seen) -> Selection:
    """What an earlier replay chose, whatever these recordings hold: a frame of their own would be another map.

    Who tells how uncertain the poses are may be new.
    """
    if earlier.pose != TF or earlier.covariances is not None:
        return earlier
    return replace(earlier, covariances=_localiser(seen, earlier.map_frame))


def choose_poses(
    seen: Seen, scans: Sequence[str], wanted: InputSettings, works: Callable[[str, PoseChoice], bool]
) -> PoseChoice:
    """Map frame and pose source for scan topics: TF, else poses in the map frame, else odometry."""
    connected = list(_connected(seen, scans, wanted))
    for choice in connected:
        if all(works(topic, choice) for topic in scans):
            return choice
    raise _no_poses(seen, scans, wanted, connected)


def _try_poses(
    seen: Seen, topic: str, wanted: InputSettings, works: Callable[[str, PoseChoice], bool]
) -> PoseChoice | None:
    try:
        return choose_poses(seen, (topic,), wanted, works)
    except UsageError:
        return None


def _connected(seen: Seen, scans: Sequence[str], wanted: InputSettings) -> Iterable[PoseChoice]:
    """Choices that the frames allow, best first."""
    lasers = [frame for topic in scans for frame in seen.scan_frames.get(topic, ())]
    if wanted.poses not in ("auto", TF):
        topic = _named_pose_topic(seen, wanted.poses)
        joined = seen.frames.connects(wanted.map_frame, topic.frame_id)
        frame = wanted.map_frame if joined else topic.frame_id
        if _reaches(seen, topic, scans):
            warnings = (*_frame_warnings(frame, wanted.map_frame), *_mount_warnings(seen, topic, lasers))
            yield PoseChoice(frame, topic.topic, warnings, _covariances(topic))
        return
    frames = [wanted.map_frame]
    if wanted.map_frame == DEFAULT_MAP_FRAME:
        frames += sorted(seen.frames.like_odom() | {p.frame_id for p in seen.poses if "odom" in p.frame_id})
    for frame in frames:
        warnings = _frame_warnings(frame, wanted.map_frame)
        if _connects(seen, frame, scans):
            yield PoseChoice(frame, TF, warnings, _localiser(seen, frame))
        if wanted.poses == "auto":
            for topic in _robot_poses(seen, frame):
                if _reaches(seen, topic, scans):
                    mount = _mount_warnings(seen, topic, lasers)
                    yield PoseChoice(frame, topic.topic, (*warnings, *mount), _covariances(topic))


def _frame_warnings(frame: str, wanted: str) -> tuple[str, ...]:
    if frame == wanted:
        return ()
    if "odom" in frame:
        return (
            f"no poses in '{wanted}': using '{frame}'; odometry drifts, "
            "so slow levels smear and places seen again do not match",
        )
    return (f"the poses are in '{frame}', not in '{wanted}': used as the map frame",)


def _named_pose_topic(seen: Seen, name: str) -> PoseTopic:
    for topic in seen.poses:
        if topic.topic == name:
            return topic
    known = "\n".join(f"--poses {as_word(topic.topic)}" for topic in seen.poses) or "--poses tf"
    msgtype = seen.topics.get(name)
    if msgtype is None:
        raise UsageError(f"no topic {name} with poses in {', '.join(seen.logs)}", hint=known)
    if msgtype in POSE_TYPES:
        raise UsageError(f"no pose could be read from {name} where scans are", hint=known)
    raise UsageError(f"{name} holds {msgtype}, not poses", hint=known)


def _robot_poses(seen: Seen, frame: str) -> list[PoseTopic]:
    """Topics with poses of the robot in a frame, best first."""
    found = [p for p in seen.poses if p.frame_id == frame and not any(word in p.topic for word in WISHES)]

    def rank(pose: PoseTopic) -> tuple[bool, int, int, str]:
        return "amcl" not in pose.topic, POSE_TYPES.index(pose.msgtype), -pose.count, pose.topic

    return sorted(found, key=rank)


def _covariances(topic: PoseTopic) -> str | None:
    """The topic itself if it tells how uncertain its poses are.

    Odometry's uncertainty is that of the drift since the start: it grows for ever, and says nothing of its neighbours.
    """
    return topic.topic if topic.msgtype in WITH_COVARIANCE and "odom" not in topic.frame_id else None


def _localiser(seen: Seen, frame: str) -> str | None:
    """The topic on which whoever sends the transforms to the map frame tells how uncertain they are."""
    names = (topic.topic for topic in _robot_poses(seen, frame) if _covariances(topic))
    return next((name for name in names if _is_of_localiser(name)), None)


def _is_of_localiser(topic: str) -> bool:
    return topic.rsplit("/", 1)[-1] == "pose" or any(word in topic for word in LOCALISERS)


def _connects(seen: Seen, frame: str, scans: Sequence[str]) -> bool:
    """Whether a frame can be joined to some scans of each topic; a driver's first ones may name another frame."""
    return all(
        any(seen.frames.connects(frame, laser) for laser in seen.scan_frames.get(topic, ()))
        for topic in scans
    )


def _reaches(seen: Seen, topic: PoseTopic, scans: Sequence[str]) -> bool:
    """Whether the frame whose pose it is can be joined to the lasers; one that is not named can."""
    return not topic.child_frame_id or _connects(seen, topic.child_frame_id, scans)


def _mount_warnings(seen: Seen, topic: PoseTopic, lasers: Sequence[str]) -> tuple[str, ...]:
    """That the poses must be the laser's own, where nothing says how it is mounted."""
    loose = sorted({laser for laser in lasers if not seen.frames.connected_to(laser) - {laser}})
    if not loose or topic.child_frame_id in loose:
        return ()
    names = ", ".join(f"'{name}'" for name in loose)
    return (f"no transform says where {names} sits on the robot: {topic.topic} is taken as its own pose",)


def _no_poses(
    seen: Seen, scans: Sequence[str], wanted: InputSettings, connected: Sequence[PoseChoice]
) -> UsageError:
    """The error that says why there are no poses, and what could be tried."""
    lasers = [(topic, frame) for topic in scans for frame in seen.scan_frames.get(topic, ())]
    if not lasers:
        return UsageError(f"no scan of {', '.join(scans)} could be read")
    target = f"'{wanted.map_frame}'"
    if wanted.map_frame == DEFAULT_MAP_FRAME:
        target += " or 'odom'"
    topic, frame = next(
        ((t, f) for t, f in lasers if not seen.frames.connects(wanted.map_frame, f)), lasers[0]
    )
    if not frame:
        hint = "set frame_id in the scanner's driver: it must be the frame that the transforms place on the robot"
        return UsageError(f"no pose for {topic}: its scans name no frame", hint=hint)
    if connected:
        topic, frame = next(
            ((t, f) for t, f in lasers if seen.frames.connects(connected[0].map_frame, f)), (topic, frame)
        )
        return UsageError(
            f"no pose for {topic}: '{connected[0].map_frame}' and '{frame}' are connected, "
            "but at no time at which there are scans",
            hint=f"timemap info {seen.logs[0]}, and compare the clocks of scans and transforms",
        )
    roots = [root for root in seen.frames.roots_of(frame) if root != wanted.map_frame]
    tries = [seen.line("--map-frame", root) for root in roots]
    tries += [seen.line("--poses", p.topic) for p in seen.poses if _reaches(seen, p, [topic])]
    hint = "\n".join(dict.fromkeys(tries))
    if not seen.frames and not seen.poses:
        return UsageError(
            f"no pose for {topic}: there are neither transforms nor poses in {', '.join(seen.logs)}",
            hint="record /tf and /tf_static with the scans, or a pose topic such as /amcl_pose",
        )
    return UsageError(
        f"no pose for {topic}: frame '{frame}' is not connected to {target} ({family(seen.frames, frame)})",
        hint=hint or what_to_record(seen.frames, frame),
    )
