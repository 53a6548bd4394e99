"""Mistakes in scenario files: each is one line that says where, what was got, what was expected and what was meant."""

from pathlib import Path

import pytest

from fogbench import learned, planners, worlds
from fogbench.bench.reading.scenario import ScenarioError, read_scenario
from fogbench.worlds.mistake import Mistake

FAMILIES = f"one of {', '.join(worlds.FAMILIES)}, or a class as file.py:Class or module:Class"
AGENTS = f"one of {', '.join([*planners.PLANNERS, *learned.LEARNED])}, or a class as file.py:Class or module:Class"

KEYS = "name, about, maps, kind, sensor, rules, tasks, budget, variants, agents, reference, episodes, seed, published"
PUBLISHED = "source, success, path_ratio, reference_ratio, test_error"
VARIED = "maps, kind, sensor, rules, tasks, budget, agents, reference, episodes, seed"

GOOD = """\
name: grid
about: Small maps.
maps:
  blobs: {size: 16, obstacles: [0, 12], obstacle_size: [1, 3]}
sensor: {radius: 3, occlusion: false}
rules: {collision: fails, slip: 0}
tasks: {distance: [1, 40]}
budget: {steps: 40}
variants:
  easy: {}
  hard: {maps: {blobs: {obstacles: [20, 30]}}, budget: {steps: 60}}
agents:
  - astar
  - memoryless
  - astar: {replan: change, label: eager}
reference: astar
episodes: 10
seed: 0
published:
  source: A paper
  success: {MACN: {easy: 96.3}}
"""

LIST = GOOD[GOOD.index("agents:") : GOOD.index("episodes:")]

BROKEN = [
    ("name: grid\n", "", ["1:1  name: missing; give text."]),
    (
        "name: grid",
        "name: a/b",
        ["1:7  name: got a/b; expected a name that a folder can have, of at most 100 characters."],
    ),
    ("name: grid", "name:", ["1:6  name: missing; give text."]),
    (
        "name: grid",
        "nmae: grid",
        [
            "1:1  name: missing; give text.",
            f"1:1  got nmae; expected one of {KEYS}. Did you mean name?",
        ],
    ),
    ("about: Small maps.", "about: [Small, maps]", ["2:8  about: got [Small, maps]; expected text."]),
    ("about:", "about: more\nabout:", ["3:1  got about again; expected each key once (it is first on line 2)."]),
    (
        "  blobs: {size: 16",
        "  bolbs: {size: 16",
        [
            f"4:3  maps: got bolbs; expected {FAMILIES}. Did you mean blobs?",
            "11:24  variants.hard.maps.blobs.size: missing; give a whole number from 2 to 4,096.",
            "11:24  variants.hard.maps.blobs.obstacle_size: missing; give two whole numbers from 1 to 1,000,000,000.",
        ],
    ),
    (
        "maps:\n",
        "maps: blobs\nmpas:\n",
        [
            "3:7  maps: got blobs; expected a mapping.",
            f"4:1  got mpas; expected one of {KEYS}. Did you mean maps?",
            "12:24  variants.hard.maps.blobs.size: missing; give a whole number from 2 to 4,096.",
            "12:24  variants.hard.maps.blobs.obstacle_size: missing; give two whole numbers from 1 to 1,000,000,000.",
        ],
    ),
    ("  blobs:", "  rooms: {}\n  blobs:", ["4:3  maps: got a mapping; expected a mapping with one map family."]),
    (
        "  blobs: {size: 16, obstacles: [0, 12], obstacle_size: [1, 3]}",
        "  []",
        [
            "4:3  maps: got []; expected a mapping.",
            "11:24  variants.hard.maps.blobs.size: missing; give a whole number from 2 to 4,096.",
            "11:24  variants.hard.maps.blobs.obstacle_size: missing; give two whole numbers from 1 to 1,000,000,000.",
        ],
    ),
    (
        "  blobs: {size: 16, obstacles: [0, 12], obstacle_size: [1, 3]}",
        "  blobs: 16",
        [
            "4:10  maps.blobs: got 16; expected a mapping.",
            "11:24  variants.hard.maps.blobs.size: missing; give a whole number from 2 to 4,096.",
            "11:24  variants.hard.maps.blobs.obstacle_size: missing; give two whole numbers from 1 to 1,000,000,000.",
        ],
    ),
    (
        "size: 16, ob",
        "sise: 16, ob",
        [
            "4:10  maps.blobs.size: missing; give a whole number from 2 to 4,096.",
            "4:11  maps.blobs: got sise; expected one of size, obstacles, obstacle_size. Did you mean size?",
        ],
    ),
    ("size: 16", "size: 1", ["4:17  maps.blobs.size: got 1; expected a whole number from 2 to 4,096."]),
    ("size: 16", "size: 1.5", ["4:17  maps.blobs.size: got 1.5; expected a whole number from 2 to 4,096."]),
    ("size: 16", "size: many", ["4:17  maps.blobs.size: got many; expected a whole number from 2 to 4,096."]),
    ("size: 16", "size:", ["4:16  maps.blobs.size: missing; give a whole number from 2 to 4,096."]),
    ("size: 16", "size: 1e3", ["4:17  maps.blobs.size: got 1e3; expected a whole number from 2 to 4,096."]),
    ("size: 16", "size: {a: 1}", ["4:17  maps.blobs.size: got {a: 1}; expected a whole number from 2 to 4,096."]),
    (
        ", obstacle_size: [1, 3]",
        "",
        ["4:10  maps.blobs.obstacle_size: missing; give two whole numbers from 1 to 1,000,000,000."],
    ),
    (
        "obstacles: [0, 12]",
        "obstacles: 12",
        ["4:32  maps.blobs.obstacles: got 12; expected two whole numbers from 0 to 1,000,000."],
    ),
    ("[1, 3]", "[3, 1]", ["4:56  maps.blobs.obstacle_size: got [3, 1]; expected two numbers, the smaller first."]),
    (
        "[1, 3]",
        "[1, 2, 3]",
        ["4:56  maps.blobs.obstacle_size: got [1, 2, 3]; expected two whole numbers from 1 to 1,000,000,000."],
    ),
    ("[1, 3]", "[1]", ["4:56  maps.blobs.obstacle_size: got [1]; expected two whole numbers from 1 to 1,000,000,000."]),
    (
        "[1, 3]",
        "[0, x]",
        [
            "4:57  maps.blobs.obstacle_size[0]: got 0; expected a whole number from 1 to 1,000,000,000.",
            "4:60  maps.blobs.obstacle_size[1]: got x; expected a whole number from 1 to 1,000,000,000.",
        ],
    ),
    ("occlusion: false", "occlusion: no", ["5:32  sensor.occlusion: got no; expected true or false."]),
    ("occlusion: false", "occlusion: 1", ["5:32  sensor.occlusion: got 1; expected true or false."]),
    (
        "occlusion: false",
        "oclusion: true",
        ["5:21  sensor: got oclusion; expected one of radius, occlusion, false_readings. Did you mean occlusion?"],
    ),
    (
        "collision: fails",
        "collision: fail",
        ["6:20  rules.collision: got fail; expected one of fails, blocked. Did you mean fails?"],
    ),
    ("slip: 0", "slip: 2", ["6:33  rules.slip: got 2; expected a number from 0 to 1."]),
    ("slip: 0", "slip: .inf", ["6:33  rules.slip: got .inf; expected a number from 0 to 1."]),
    ("rules: {collision: fails, slip: 0}", "rules:", ["6:7  rules: missing; give a mapping."]),
    ("rules: {collision: fails, slip: 0}", "rules: [fails]", ["6:8  rules: got [fails]; expected a mapping."]),
    ("budget: {steps: 40}\n", "", ["9:9  variants.easy.budget: missing; give a mapping."]),
    (
        "{steps: 40}",
        "{steps: 0}",
        ["8:17  budget.steps: got 0; expected a whole number from 1 to 1,000,000,000 or a mapping."],
    ),
    (
        "{steps: 40}",
        "{steps: {plus: 20}}",
        ["8:17  budget.steps.per_distance: missing; give a number above 0 and up to 1,000."],
    ),
    (
        "{steps: 40}",
        "{steps: {per_distance: 0, pls: 3}}",
        [
            "8:32  budget.steps.per_distance: got 0; expected a number above 0 and up to 1,000.",
            "8:35  budget.steps: got pls; expected one of per_distance, plus. Did you mean plus?",
        ],
    ),
    (
        "{steps: 40}",
        "{steps: 40, hard_seconds: -1}",
        ["8:35  budget.hard_seconds: got -1; expected a number above 0 and up to 1,000,000."],
    ),
    (
        "{steps: 40}",
        "{steps: 40, memory_bytes: 1 MB}",
        ["8:35  budget.memory_bytes: got 1 MB; expected a whole number from 1 to 1,000,000,000,000,000 or nothing."],
    ),
    ("  easy: {}", "  easy: 5", ["10:9  variants.easy: got 5; expected a mapping or nothing."]),
    (
        "  easy: {}",
        "  easy: {name: other}",
        [f"10:10  variants.easy: got name; expected one of {VARIED}."],
    ),
    (
        "  easy: {}",
        "  easy: {sensr: {radius: 1}}",
        [f"10:10  variants.easy: got sensr; expected one of {VARIED}. Did you mean sensor?"],
    ),
    (
        "{steps: 60}",
        "{steps: none}",
        ["11:64  variants.hard.budget.steps: got none; expected a whole number from 1 to 1,000,000,000 or a mapping."],
    ),
    (
        "obstacles: [20, 30]",
        "obstacles: [20, 3]",
        ["11:36  variants.hard.maps.blobs.obstacles: got [20, 3]; expected two numbers, the smaller first."],
    ),
    (
        "  - memoryless",
        "  - memoryles",
        [f"14:5  agents[1]: got memoryles; expected {AGENTS}. Did you mean memoryless?"],
    ),
    (
        "  - memoryless",
        "  - [memoryless]",
        ["14:5  agents[1]: got [memoryless]; expected the name of an agent, or one name with its settings."],
    ),
    (
        "  - memoryless",
        "  - {memoryless: , a: }",
        ["14:5  agents[1]: got {memoryless: , a: }; expected the name of an agent, or one name with its settings."],
    ),
    ("  - memoryless", "  - memoryless: {depth: 3}", ["14:18  agents[1].memoryless: got depth; expected no settings."]),
    ("  - memoryless", "  - memoryless: 3", ["14:17  agents[1].memoryless: got 3; expected a mapping."]),
    (
        "  - memoryless",
        "  - astar",
        ["14:5  agents[1]: got astar; expected a label of its own (astar is taken on line 13)."],
    ),
    (
        "label: eager",
        "label: memoryless",
        ["15:36  agents[2].astar.label: got memoryless; expected a label of its own (memoryless is taken on line 14)."],
    ),
    ("label: eager", "label: [eager]", ["15:36  agents[2].astar.label: got [eager]; expected text."]),
    (
        "replan: change",
        "replan: chang",
        ["15:21  agents[2].astar.replan: got chang; expected one of cut, change. Did you mean change?"],
    ),
    (
        "reference: astar",
        "reference: eagr",
        ["16:12  reference: got eagr; expected one of astar, memoryless, eager. Did you mean eager?"],
    ),
    ("reference: astar", "reference: [astar]", ["16:12  reference: got [astar]; expected text or nothing."]),
    ("episodes: 10", "episodes: 0", ["17:11  episodes: got 0; expected a whole number from 1 to 1,000,000."]),
    ("episodes: 10\n", "", ["1:1  episodes: missing; give a whole number from 1 to 1,000,000."]),
    ("seed: 0", "seed: soon", ["18:7  seed: got soon; expected a whole number from 0 to 4,294,967,295."]),
    ("  source: A paper\n", "", ["20:3  published.source: missing; give text."]),
    (
        "easy: 96.3",
        "esy: 96.3",
        ["21:20  published.success.MACN: got esy; expected one of easy, hard. Did you mean easy?"],
    ),
    ("easy: 96.3", "easy: most", ["21:26  published.success.MACN.easy: got most; expected a number from 0 to 100."]),
    ("easy: 96.3", "easy: .nan", ["21:26  published.success.MACN.easy: got .nan; expected a number from 0 to 100."]),
    ("easy: 96.3", "easy: 130", ["21:26  published.success.MACN.easy: got 130; expected a number from 0 to 100."]),
    (
        "  success:",
        "  sucess:",
        [f"21:3  published: got sucess; expected one of {PUBLISHED}. Did you mean success?"],
    ),
    ("  success: {MACN: {easy: 96.3}}", "  success: 96.3", ["21:12  published.success: got 96.3; expected a mapping."]),
    (
        "seed: 0",
        "seed: 0\n\tx: 1",
        ["19:1  got broken YAML (found character '\\t' that cannot start any token); expected one YAML document."],
    ),
    ("seed: 0", "seed: [0", ["19:10  got broken YAML (expected ',' or ']', but got ':'); expected one YAML document."]),
    (
        "seed: 0",
        "seed: 0\n   x: 1",
        ["19:5  got broken YAML (mapping values are not allowed here); expected one YAML document."],
    ),
    ("seed: 0", "seed: *zero", ["18:7  got broken YAML (found undefined alias 'zero'); expected one YAML document."]),
    (
        "seed: 0",
        "seed: 0\n---\nname: two",
        ["19:1  got broken YAML (found another document); expected one YAML document."],
    ),
    ("seed: 0", "seed: 0\n<<: {episodes: 3}", ["19:1  got <<; expected keys written out; merge keys are not read."]),
    ("seed: 0", "seed: 0\n[a, b]: 1", ["19:1  got [a, b]; expected a key that is text."]),
    (
        "seed: 0",
        "seed: &s [*s]",
        [
            "18:7  seed[0]: got &s [*s]; expected an alias of something that does not hold the alias.",
            "18:7  seed: got &s [*s]; expected a whole number from 0 to 4,294,967,295.",
        ],
    ),
    (
        "seed: 0",
        "seed: \x07",
        ["18:7  got broken YAML (special characters are not allowed: '\\x07'); expected one YAML document."],
    ),
    (
        "size: 16",
        "size: 16, size: 17",
        ["4:21  maps.blobs: got size again; expected each key once (it is first on line 4)."],
    ),
    (LIST, "agents: []\n", ["12:9  agents: got []; expected a list of at least 1."]),
    (LIST, "agents: astar\n", ["12:9  agents: got astar; expected a list of at least 1."]),
    (
        "about: Small maps.",
        "about: {a long mapping with: many words, that goes: on and on, until: the end}",
        ["2:8  about: got {a long mapping with: many words, that goes: on and on, unti...; expected text."],
    ),
]
"""What is written in GOOD, what is written in its place, and the lines about it, without the name of the file."""


BOMB = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"a{level}: &a{level} [{', '.join([f'*a{level - 1}'] * 10)}]\n" for level in range(1, 9)
)


def mistakes(text: str) -> list[str]:
    """The lines about a text, without the name of the file."""
    with pytest.raises(ScenarioError) as error:
        read_scenario(text, Path("broken.yaml"))
    return [line.removeprefix("broken.yaml:") for line in error.value.lines]


@pytest.mark.parametrize(("old", "new", "lines"), BROKEN)
def test_a_mistake_is_told_at_its_place(old: str, new: str, lines: list[str]) -> None:
    """Each broken file has exactly these lines, and none of them twice."""
    assert old in GOOD
    assert mistakes(GOOD.replace(old, new, 1)) == lines


def test_the_file_that_the_others_are_made_from_is_good() -> None:
    """So every line above is about the one change."""
    assert len(read_scenario(GOOD, Path("good.yaml")).variants) == 2


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("", "1:1  got an empty file; expected a mapping."),
        ("# nothing but this\n", "1:1  got an empty file; expected a mapping."),
        ("~", "1:1  got ~; expected a mapping."),
        ("\n- name: grid\n- seed: 1\n", "2:1  got a list; expected a mapping."),
        ("grid", "1:1  got grid; expected a mapping."),
    ],
)
def test_a_file_that_is_no_mapping_has_one_mistake(text: str, line: str) -> None:
    """Nothing else is said about it."""
    assert mistakes(text) == [line]


@pytest.mark.parametrize(
    ("text", "line"),
    [
        (
            f"a: {'[' * 101}{']' * 101}",
            "1:104  got broken YAML (nested more than 100 deep); expected one YAML document.",
        ),
        ("[" * 3000 + "]" * 3000, "1:102  got broken YAML (nested more than 100 deep); expected one YAML document."),
        (BOMB, "1:37  got broken YAML (more than 100,000 values, aliases counted); expected one YAML document."),
    ],
    ids=["deep", "deeper", "bomb"],
)
def test_a_file_that_nobody_could_read_to_its_end_has_one_mistake(text: str, line: str) -> None:
    """One nested without end, and aliases of aliases that stand for a thousand million values."""
    assert mistakes(text) == [line]


def test_all_mistakes_are_told_in_order() -> None:
    """Eleven mistakes in every part of a file are found in one go, in the order of their places."""
    text = """\
maps: {blobs: {sise: 16, obstacles: [9, 1], obstacle_size: [1, 3]}}
sensor: {radius: 1.5}
budget: {steps: 40}
variants:
  easy: {tasks: {distance: far}}
  hard: {rules: {slip: 3}}
agents: [aster, {memoryless: {x: 1}}]
reference: A*
episodes: -1
"""
    assert mistakes(text) == [
        "1:1  name: missing; give text.",
        "1:15  maps.blobs.size: missing; give a whole number from 2 to 4,096.",
        "1:16  maps.blobs: got sise; expected one of size, obstacles, obstacle_size. Did you mean size?",
        "1:37  maps.blobs.obstacles: got [9, 1]; expected two numbers, the smaller first.",
        "2:18  sensor.radius: got 1.5; expected a whole number from 1 to 1,024.",
        "5:28  variants.easy.tasks.distance: got far; expected two whole numbers from 1 to 1,000,000,000 or nothing.",
        "6:24  variants.hard.rules.slip: got 3; expected a number from 0 to 1.",
        f"7:10  agents[0]: got aster; expected {AGENTS}. Did you mean astar?",
        "7:31  agents[1].memoryless: got x; expected no settings.",
        "8:12  reference: got A*; expected one of aster, memoryless.",
        "9:11  episodes: got -1; expected a whole number from 1 to 1,000,000.",
    ]


def test_what_all_variants_lack_is_told_once() -> None:
    """It is a mistake of what they are laid over; what only some lack is a mistake of each of those."""
    spread = GOOD.replace("size: 16, ", "").replace("hard: {maps", "hard: {sensor: {radius: 1}, maps")
    assert mistakes(spread) == ["4:10  maps.blobs.size: missing; give a whole number from 2 to 4,096."]
    partly = spread.replace("easy: {}", "easy: {maps: {blobs: {size: 9}}}")
    assert mistakes(partly) == ["11:45  variants.hard.maps.blobs.size: missing; give a whole number from 2 to 4,096."]


def test_a_mistake_behind_an_alias_is_told_where_it_is_written() -> None:
    """The path is that of its use, the place that of its text; a second use in the same way is a second line."""
    text = GOOD.replace("obstacles: [0, 12]", "obstacles: &few [9, 1]").replace("[20, 30]", "*few")
    assert mistakes(text) == [
        "4:32  maps.blobs.obstacles: got &few [9, 1]; expected two numbers, the smaller first.",
        "4:32  variants.hard.maps.blobs.obstacles: got &few [9, 1]; expected two numbers, the smaller first.",
    ]


def test_an_error_names_the_file_and_is_a_mistake_of_the_user() -> None:
    """The command line prints a `Mistake` as it is: all lines, each with the path that was given."""
    with pytest.raises(Mistake) as error:
        read_scenario(GOOD.replace("seed: 0", "seed: x").replace("episodes: 10", "episodes: x"), Path("some/file.yaml"))
    assert str(error.value) == (
        "some/file.yaml:17:11  episodes: got x; expected a whole number from 1 to 1,000,000.\n"
        "some/file.yaml:18:7  seed: got x; expected a whole number from 0 to 4,294,967,295."
    )
