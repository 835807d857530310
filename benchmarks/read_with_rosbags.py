"""What a replay is measured against: rosbags.highlevel reads and deserialises the same topics."""

import sys
from pathlib import Path

from rosbags.highlevel import AnyReader

TOPICS = ("/scan", "/tf", "/tf_static")


def read(path: Path) -> int:
    """Number of messages read and deserialised."""
    count = 0
    with AnyReader([path]) as reader:
        connections = [connection for connection in reader.connections if connection.topic in TOPICS]
        for connection, _, raw in reader.messages(connections=connections):
            reader.deserialize(raw, connection.msgtype)
            count += 1
    return count


if __name__ == "__main__":
    sys.stdout.write(f"{read(Path(sys.argv[1]))}\n")
