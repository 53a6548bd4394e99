"""Graphs: agents that go by the graph seen so far, and who judges and teaches there."""
