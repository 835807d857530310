"""What is measured: each module makes, replays and judges one kind of recordings."""
