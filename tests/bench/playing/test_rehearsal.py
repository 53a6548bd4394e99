"""`check` finds agents that cannot play, before a run does."""

from collections.abc import Callable
from pathlib import Path

import pytest
import yaml

from fogbench.bench.check import check_all
from fogbench.worlds.mistake import Mistake

WAYS = {
    "no_act": ("AttributeError", "del Faulty.act"),
    "raises": ("ValueError: my word", "    raise ValueError('my word')"),
    "nonsense": ("TypeError: act returned 'north' (str)", "    return 'north'"),
    "opens": ("FileNotFoundError: [Errno 2] No such file or directory: 'weights'", "    open('weights')"),
    "memory": ("TypeError: memory_bytes returned None", "    pass"),
    "hangs": ("no answer after 2 s", "    import time; time.sleep(100)"),
    "leaves": ("the agent's process ended with exit code 4", "    import os; os._exit(4)"),
}

FILE = """
from typing import ClassVar
from fogbench import Settings

class Mine(Settings):
    kinds: ClassVar[frozenset[str]] = frozenset({"grid"})

    def start(self, task, rng):
        return Faulty()

    def parameter_bytes(self):
        return 0

class Faulty:
    def act(self, observation):
        "Decides."
    BODY

    def memory_bytes(self):
        return COUNT

    def search_nodes(self):
        return 0

"""

SCENARIO = {
    "name": "rude",
    "maps": {"blobs": {"size": 8, "obstacles": [0, 3], "obstacle_size": [1, 2]}},
    "variants": {
        "one": {"budget": {"steps": 40, "hard_seconds": 2}},
        "two": {"budget": {"steps": 50, "hard_seconds": 2}},
    },
    "episodes": 2,
}

Check = Callable[..., list[str]]


@pytest.fixture
def check(tmp_path: Path) -> Check:
    """Checks a scenario of agents that fail in these ways; the lines that it tells."""

    def check(*ways: str) -> list[str]:
        for way in ways:
            code = WAYS[way][1] if way in WAYS else ""
            body, end = (code, "") if code.startswith(" ") else ("", code)
            count = "None" if way == "memory" else "0"
            (tmp_path / f"{way}.py").write_text(FILE.replace("BODY", body).replace("COUNT", count) + end + "\n")
        agents = ["astar", *({f"./{way}.py:Mine": {"label": way}} for way in ways)]
        (tmp_path / "rude.yaml").write_text(yaml.safe_dump({**SCENARIO, "agents": agents}, sort_keys=False))
        try:
            check_all([tmp_path / "rude.yaml"])
        except Mistake as mistake:
            return str(mistake).splitlines()
        return []

    return check


def test_what_cannot_decide_is_told_in_one_line_at_its_place(check: Check, tmp_path: Path) -> None:
    """Once for each agent, in the order of the file, though two variants have it."""
    lines = check(*WAYS, "fine")
    assert len(lines) == len(WAYS)
    text = (tmp_path / "rude.yaml").read_text().splitlines()
    for way, line in zip(WAYS, lines, strict=True):
        number = text.index(f"- ./{way}.py:Mine:") + 1
        assert line.startswith(f"{tmp_path}/rude.yaml:{number}:3  agents[")
        assert (
            f": got ./{way}.py:Mine; expected an agent that can decide; its first decision in variant one ended with"
            in line
        )
        assert WAYS[way][0] in line


def test_who_can_decide_passes(check: Check, capsys: pytest.CaptureFixture[str]) -> None:
    """Giving up is a decision."""
    assert check("fine") == []
    assert "one: 2 episodes of 2 agents" in capsys.readouterr().out
