"""Learned policies, by the name they have in a scenario. Importing this imports none of them."""

LEARNED: dict[str, str] = {}
"""Policies that ship with the project, as `module:class`."""
