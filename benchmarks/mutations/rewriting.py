"""A recording as another recording, message by message."""

import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import StoragePlugin, Writer

Change = Callable[[Any, int], Any]  # of a message and when it was logged [ns since the first]; None drops it


def rewrite(source: Path, target: Path, change: Change) -> None:
    """Write `source` to the MCAP file `target`, each message as `change` has it."""
    with tempfile.TemporaryDirectory(dir=target.parent) as folder:
        made = Path(folder) / target.stem
        with (
            AnyReader([source]) as reader,
            Writer(made, version=8, storage_plugin=StoragePlugin.MCAP) as writer,
        ):
            store = reader.typestore
            written = {
                one.id: writer.add_connection(
                    one.topic,
                    one.msgtype,
                    typestore=store,
                    offered_qos_profiles=getattr(one.ext, "offered_qos_profiles", ()),  # latched or not
                )
                for one in reader.connections
            }
            for connection, log_ns, raw in reader.messages():
                message = change(reader.deserialize(raw, connection.msgtype), log_ns - reader.start_time)
                if message is not None:
                    written_as = store.serialize_cdr(message, connection.msgtype)
                    writer.write(written[connection.id], log_ns, written_as)
        shutil.move(made / target.name, target)
