"""The episode loop, the processes that run it, and the store of what was played."""
