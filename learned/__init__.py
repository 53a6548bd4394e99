"""Learned policies, by the name they have in a scenario. Importing this imports none of them."""

LEARNED = {
    "macn": "fogbench.learned.macn:Macn",
    "vin": "fogbench.learned.vin:Vin",
    "cnn_memory": "fogbench.learned.cnn_memory:CnnMemory",
    "macn_graph": "fogbench.learned.macn_graph:MacnGraph",
    "vin_graph": "fogbench.learned.vin_graph:VinGraph",
    "macn_explored": "fogbench.learned.macn_explored:MacnExplored",
    "cnn_memory_graph": "fogbench.learned.cnn_memory_graph:CnnMemoryGraph",
    "macn_robot": "fogbench.learned.macn_robot:MacnRobot",
    "vin_robot": "fogbench.learned.vin_robot:VinRobot",
    "cnn_memory_robot": "fogbench.learned.cnn_memory_robot:CnnMemoryRobot",
}
"""Policies that ship with the project, as `module:class`."""

ENCODINGS = {
    "grid": "fogbench.learned.encoding.grid:GridEncoding",
    "graph": "fogbench.learned.encoding.graph:GraphEncoding",
    "robot": "fogbench.learned.encoding.robot:RobotEncoding",
}
"""What networks see of an episode, and what their outputs mean, by the kind of world (see `encoding.encoding`).

Other packages add theirs by the group `fogbench.encodings`.
"""

LEARNERS = {"imitation": "fogbench.learned.training.imitation:Imitation"}
"""How networks learn, by the name under `learning:` in a recipe; others by the group `fogbench.learners`."""

EXTRAS = dict.fromkeys(LEARNED, "learned")
"""The extra of the project (`pip install ".[learned]"`) that a policy needs."""

PACKAGES = {"learned": ("safetensors", "torch")}
"""Packages that an extra brings, and that a policy cannot play without; its settings alone do not import them all."""
