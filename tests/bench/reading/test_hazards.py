"""What YAML and its writers can do to a page: each ends in lines with a place, never in anything else."""

import random
import re
from collections.abc import Callable
from contextlib import suppress
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from fogbench.bench.reading.recipe import read_recipe
from fogbench.bench.reading.scenario import LARGEST, ScenarioError, read_scenario, text_of
from fogbench.bench.shipped import RECIPES, folder
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.reading.document import DEEPEST

PAGE = """
name: page
maps: {blobs: {size: 12, obstacles: [2, 4], obstacle_size: [2, 3]}}
sensor: {radius: 3}
budget: {steps: 40, hard_seconds: 9, memory_bytes: 99}
tasks: {distance: [1, 9]}
agents: [astar, {rrt_star: {iterations: 9}}, {macn: {checkpoint: none}}]
episodes: 3
seed: 1
"""

DIGITS = "9" * 5000

NUMBERS = [
    ("size: 12", "size: 1000000000", "maps.blobs.size: got 1000000000; expected a whole number from 2 to 4,096."),
    ("[2, 4]", "[2, 1000000000]", "obstacles[1]: got 1000000000; expected a whole number from 0 to 1,000,000."),
    ("radius: 3", "radius: 2000", "sensor.radius: got 2000; expected a whole number from 1 to 1,024."),
    ("steps: 40", f"steps: {2**63}", "expected a whole number from 1 to 1,000,000,000 or a mapping."),
    ("steps: 40", f"steps: {DIGITS}", "expected a whole number from 1 to 1,000,000,000 or a mapping."),
    ("steps: 40", "steps: 0x10", "expected a whole number from 1 to 1,000,000,000 or a mapping."),
    ("steps: 40", "steps: 1:30", "expected a whole number from 1 to 1,000,000,000 or a mapping."),
    ("steps: 40", "steps: {per_distance: 1e300}", "got 1e300; expected a number above 0 and up to 1,000."),
    ("steps: 40", "steps: {per_distance: .inf}", "got .inf; expected a number above 0 and up to 1,000."),
    ("steps: 40", "steps: {per_distance: 2, plus: 1e9}", "got 1e9; expected a whole number from 0 to 1,000,000,000."),
    ("hard_seconds: 9", "hard_seconds: 1e400", "got 1e400; expected a number above 0 and up to 1,000,000."),
    ("hard_seconds: 9", "hard_seconds: .nan", "got .nan; expected a number above 0 and up to 1,000,000."),
    ("memory_bytes: 99", "memory_bytes: -1", "expected a whole number from 1 to 1,000,000,000,000,000 or nothing."),
    ("iterations: 9", f"iterations: {10**9}", "expected a whole number from 1 to 1,000,000."),
    ("episodes: 3", "episodes: 1000000000", "expected a whole number from 1 to 1,000,000."),
    ("seed: 1", f"seed: {DIGITS}", "expected a whole number from 0 to 4,294,967,295."),
    ("checkpoint: none", "checkpoint: none, writes: 1000", "expected a whole number from 1 to 64."),
    ("checkpoint: none", "checkpoint: none, size: [1024, 1024], features: 1024",
     "weights of at most 1,073,741,824 bytes"),
    ("blobs: {size: 12, obstacles: [2, 4], obstacle_size: [2, 3]}", "tunnel: {length: [9000, 9000], bends: [0, 1]}",
     "expected a length of at most 8,192 where there are bends."),
]  # fmt: skip


def lines(text: str) -> list[str]:
    """What a scenario's reader says."""
    with pytest.raises(ScenarioError) as caught:
        read_scenario(text, Path("page.yaml"))
    return caught.value.lines


@pytest.mark.parametrize(("old", "new", "told"), NUMBERS, ids=[new[:40] for _, new, _ in NUMBERS])
def test_numbers_have_bounds(old: str, new: str, told: str) -> None:
    """Whatever could overflow or fill the memory is refused, with the bound."""
    assert old in PAGE
    (line,) = lines(PAGE.replace(old, new))
    assert re.match(r"page\.yaml:\d+:\d+  ", line)
    assert told in line


NAMES = ["''", "' '", ".", "..", "a/b", "'a '", "a.", "con", "LPT1.txt", "x" * 101, '"a\\nb"', '"\\ud800"', '"\\0"']


@pytest.mark.parametrize("name", NAMES)
def test_names_are_those_of_folders(name: str) -> None:
    """So that results can be written on any machine."""
    assert lines(PAGE.replace("name: page", f"name: {name}"))[0].startswith("page.yaml:2:7  name: got ")


@pytest.mark.parametrize("label", ["''", "x" * 101, '"a\\nb"', '"\\udfff"'])
def test_labels_can_be_printed(label: str) -> None:
    """And are no longer than a file's name can be."""
    (line,) = lines(PAGE.replace("[astar,", f"[{{astar: {{label: {label}}}}},"))
    assert line.startswith("page.yaml:7:26  agents[0].astar.label: got ")


BOMB = "a: &a [x, x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{b}: &{b} [{', '.join([f'*{a}'] * 10)}]\n" for a, b in pairwise("abcdefg")
)
"""Ten million values, by aliases."""

BROKEN = [
    ("\x00", "broken YAML (special characters are not allowed: '\\x00')"),
    ("a: \x07", "broken YAML (special characters are not allowed: '\\x07')"),
    ("a:\tb\n\tc: d", "broken YAML ("),
    ('a: "\\U00110000"', "broken YAML (chr() arg not in range(0x110000))"),
    ('a: "\\UFFFFFFFF"', "broken YAML ("),
    (f"%YAML {DIGITS}.1\n---\na: 1", "broken YAML ("),
    ("[" * 2000, "broken YAML ("),
    ("a: " * 3, "broken YAML (mapping values are not allowed here)"),
    ("{a: " * (DEEPEST + 2) + "1" + "}" * (DEEPEST + 2), "nested more than 100 deep"),
    (BOMB, "more than 100,000 values"),
    ("a: 1\n---\nb: 2", "broken YAML ("),
    ("", "an empty file"),
    ("- a", "got - a; expected a mapping"),
    ("just text", "got just text; expected a mapping"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "told"), BROKEN, ids=range(len(BROKEN)))
def test_broken_pages_are_told(text: str, told: str) -> None:
    """In one line, with a place."""
    (line,) = lines(text)
    assert re.match(r"page\.yaml:\d+:\d+  ", line)
    assert told in line


KEYS = [
    "~: 1",
    "3: 1",
    "[a, b]: 1",
    "{a: b}: 1",
    "? [a]",
    "<<: {a: 1}",
    '"\\ud800": 1',
    '"a\\nb": 1',
    f"{'k' * 5000}: 1",
]


@pytest.mark.parametrize("key", KEYS, ids=range(len(KEYS)))
def test_odd_keys_are_told(key: str) -> None:
    """In one line, whatever stands in them."""
    (line,) = lines(f"{PAGE}{key}\n")
    assert line.startswith("page.yaml:10:")
    assert len(line) < 500
    assert line.isprintable()


def test_tags_are_told() -> None:
    """Nothing is made of them; the plain ones of YAML mean nothing here."""
    tagged = PAGE.replace("radius: 3", "radius: !!python/object/apply:os.system [ls]")
    assert lines(tagged)[0] == (
        "page.yaml:4:18  sensor.radius: got !!python/object/apply:os.system [ls]; expected a value without a tag."
    )
    assert read_scenario(PAGE.replace("radius: 3", "radius: !!int 3"), Path("page.yaml")).variants


def test_files_that_cannot_be_read_are_told(tmp_path: Path) -> None:
    """Too large, of another encoding, or no file; a byte order mark is no mistake."""
    page = tmp_path / "page.yaml"
    page.write_text(PAGE, encoding="utf-8-sig")
    assert text_of(page) == PAGE
    for contents in (PAGE.encode("utf-16"), b"\xff", b"#" * (LARGEST + 1)):
        page.write_bytes(contents)
        with pytest.raises(ScenarioError, match="got a file "):
            text_of(page)
    with pytest.raises(ScenarioError, match="got a file that cannot be read"):
        text_of(tmp_path)
    with pytest.raises(ScenarioError, match="got a file of more letters; expected at most 1,000,000"):
        text_of(Path("/dev/zero"))


PIECES = [
    *"{}[]:,|>!%@`'\"#\\\t\n",
    *(": ", "- ", "&a ", "*a", "!!int ", "  "),
    *("null", "~", "true", ".inf", ".nan", "-1", "0", "1e400", "0x10", DIGITS),
    *("\ufeff", "\u2028", "é", "${HOME}", "${NONE_SUCH}"),
    *("maps", "agents", "variants", "seed", "label", "maze", "astar", "none", "x.py:X", "os:path", "a b"),
]
"""What a mutation puts somewhere."""


def mutated(text: str, luck: random.Random) -> str:
    """A text with some pieces put in, cut out, doubled or swapped."""
    for _ in range(luck.randint(1, 3)):
        a, b = sorted(luck.randrange(len(text) + 1) for _ in range(2))
        b = min(b, a + luck.choice((0, 1, 3, 20)))
        text = text[:a] + luck.choice((luck.choice(PIECES), "", text[a:b] * 2)) + text[b:]
    return text


@pytest.mark.parametrize(
    ("read", "place"), [(read_scenario, folder()), (read_recipe, RECIPES)], ids=["scenario", "recipe"]
)
def test_mutated_pages_are_read_or_told(
    read: Callable[[str, Path], Any], place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Hundreds of shipped pages with a few letters changed: none ends in anything but a mistake."""
    monkeypatch.delenv("NONE_SUCH", raising=False)
    luck, pages = random.Random(0), sorted(place.rglob("*.yaml"))
    for number in range(300):
        page = pages[number % len(pages)]
        text = mutated(page.read_text("utf-8")[:1500], luck)
        with suppress(Mistake):
            read(text, page)
