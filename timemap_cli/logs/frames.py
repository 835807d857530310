"""The frames of some recordings as a graph: which are connected, and which stand above which."""

from collections import defaultdict
from collections.abc import Iterable


class Frames:
    """An unchanging graph of frames, made of edges (parent, child)."""

    def __init__(self, edges: Iterable[tuple[str, str]]) -> None:
        self._parents: defaultdict[str, set[str]] = defaultdict(set)
        self._neighbours: defaultdict[str, set[str]] = defaultdict(set)
        for parent, child in edges:
            self._parents[child].add(parent)
            self._neighbours[parent].add(child)
            self._neighbours[child].add(parent)

    def __bool__(self) -> bool:
        return bool(self._neighbours)

    def names(self) -> set[str]:
        """All frames."""
        return set(self._neighbours)

    def connected_to(self, frame: str) -> set[str]:
        """All frames that can be reached from one, itself among them."""
        reached, open_ends = {frame}, [frame]
        while open_ends:
            for name in self._neighbours.get(open_ends.pop(), ()):
                if name not in reached:
                    reached.add(name)
                    open_ends.append(name)
        return reached

    def connects(self, target: str, source: str) -> bool:
        """Whether a chain of edges leads from one frame to the other; False for an unknown frame."""
        return target in self._neighbours and source in self.connected_to(target)

    def roots_of(self, frame: str) -> list[str]:
        """The topmost frames above one that are not parts of a robot, sorted; none if nothing is above it."""
        above, open_ends = set[str](), [frame]
        while open_ends:
            for parent in self._parents.get(open_ends.pop(), ()):
                if parent not in above:
                    above.add(parent)
                    open_ends.append(parent)
        return sorted(name for name in above if not self._parents.get(name) and not name.startswith("base"))

    def like_odom(self) -> set[str]:
        """Frames that are called after odometry."""
        return {name for name in self._neighbours if "odom" in name}

    def path(self, target: str, source: str) -> tuple[str, ...]:
        """The frames of a shortest chain between two, both ends included; empty where there is none."""
        before: dict[str, str] = {}
        front = [target]
        while front and source not in front:
            following = []
            for frame in front:
                for name in sorted(self._neighbours.get(frame, ())):
                    if name not in before and name != target:
                        before[name] = frame
                        following.append(name)
            front = following
        if not front:
            return ()
        chain = [source]
        while chain[-1] != target:
            chain.append(before[chain[-1]])
        return tuple(reversed(chain))
