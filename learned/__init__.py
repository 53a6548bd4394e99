"""Learned policies, by the name they have in a scenario. Importing this imports none of them."""

LEARNED = {
    "macn": "fogbench.learned.macn:Macn",
    "vin": "fogbench.learned.vin:Vin",
    "cnn_memory": "fogbench.learned.cnn_memory:CnnMemory",
}
"""Policies that ship with the project, as `module:class`."""

EXTRAS = dict.fromkeys(LEARNED, "learned")
"""The extra of the project (`pip install ".[learned]"`) that a policy needs."""
