"""A result written anew with something else in it, its checksums right: what an attacker would hand over."""

from collections.abc import Callable
from pathlib import Path

from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

from timemap_cli.results import channels

Change = Callable[[bytes], bytes]


def rewritten(
    source: Path,
    target: Path,
    *,
    metadata: dict[str, str] | None = None,
    attachments: dict[str, bytes] | None = None,
    messages: dict[str, Change] | None = None,
    without: tuple[str, ...] = (),
) -> Path:
    """Copy a result; values replace those of the metadata, texts the attachments, functions change a topic's messages.

    Topics and attachments in `without` are left out.
    """
    with source.open("rb") as file, target.open("wb") as out:
        reader = make_reader(file)
        writer = Writer(out, compression=CompressionType.ZSTD)
        writer.start(profile="ros2", library="an attacker")
        ids: dict[str, int] = {}
        for schema, channel, message in reader.iter_messages():
            if channel.topic in without:
                continue
            if channel.topic not in ids:
                schema_id = writer.register_schema(schema.name, schema.encoding, schema.data)
                ids[channel.topic] = writer.register_channel(
                    channel.topic, channel.message_encoding, schema_id, channel.metadata
                )
            change = (messages or {}).get(channel.topic, lambda data: data)
            writer.add_message(
                ids[channel.topic], message.log_time, change(message.data), message.publish_time
            )
        for one in reader.iter_attachments():
            if one.name not in without:
                data = (attachments or {}).get(one.name, one.data)
                writer.add_attachment(one.create_time, one.log_time, one.name, one.media_type, data)
        for record in reader.iter_metadata():
            changed = (
                record.metadata | (metadata or {}) if record.name == channels.METADATA else record.metadata
            )
            writer.add_metadata(record.name, changed)
        writer.finish()
    return target
