"""Mistakes in recipes are told like those in scenarios; what is right becomes worlds, a network and its training."""

from pathlib import Path
from typing import cast

import pytest

from fogbench import learned, worlds
from fogbench.bench.reading.page import with_blocks
from fogbench.bench.reading.recipe import RecipePage, read_recipe
from fogbench.bench.reading.scenario import ScenarioError
from fogbench.learned.checkpoint import SHIPPED
from fogbench.learned.macn import Macn
from fogbench.learned.training.imitation import Imitation, Teacher
from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.maps.families.tunnel import Tunnel
from fogbench.worlds.mistake import Mistake

FAMILIES = f"one of {', '.join(worlds.FAMILIES)}, or a class as file.py:Class or module:Class"
NETWORKS = f"one of {', '.join(learned.LEARNED)}, or a class as file.py:Class or module:Class"
KEYS = ", ".join(with_blocks(RecipePage, GridConditions).model_fields)
LEARNERS = f"one of {', '.join(learned.LEARNERS)}, or a class as file.py:Class or module:Class"
LEARNING = f"one of {', '.join(Imitation.model_fields)}"
CHECKPOINTS = ", ".join(["none", *sorted(card.stem for card in SHIPPED.glob("*.json"))])
SETTINGS = f"one of {', '.join(Macn.model_fields)}"

GOOD = """\
name: small
about: Small maps.
network: {macn: {memory: lstm}}
maps:
  blobs: {size: 16, obstacles: [0, 12], obstacle_size: [1, 3]}
sensor: {radius: 3}
budget: {steps: 40}
learning:
  imitation:
    curriculum: {easy: {obstacles: [2, 2]}, until: 0.3}
    teacher: {share: [1, 0.1], until: 0.25}
    batches: 100
    optimiser: adam
    rate: [1e-3, 1e-4]
variants:
  32x32: {maps: {blobs: {size: 32}}, budget: {steps: 60}}
seed: 2
"""

BROKEN = [
    ("name: small\n", "", ["1:1  name: missing; give text."]),
    (
        "name: small",
        "name: a/b",
        ["1:7  name: got a/b; expected a name that a folder can have, of at most 100 characters."],
    ),
    ("macn:", "mcan:", [f"3:11  network: got mcan; expected {NETWORKS}. Did you mean macn?"]),
    ("macn:", "astar:", [f"3:11  network: got astar; expected {NETWORKS}."]),
    ("{macn: {memory: lstm}}", "[macn]", ["3:10  network: got [macn]; expected a mapping or text."]),
    (
        "{macn: {memory: lstm}}",
        "{macn: {}, vin: {}}",
        ["3:10  network: got {macn: {}, vin: {}}; expected the name of a network, or one name with its settings."],
    ),
    (
        "memory: lstm",
        "memory: lstn",
        ["3:26  network.macn.memory: got lstn; expected one of dnc, lstm, gru, feedforward. Did you mean lstm?"],
    ),
    (
        "memory: lstm",
        "sede: 3",
        [
            f"3:18  network.macn: got sede; expected {SETTINGS}. Did you mean seed?",
        ],
    ),
    (
        "memory: lstm",
        "seed: 3",
        ["3:18  network.macn: got seed; expected the recipe's own seed, which fixes the weights too."],
    ),
    ("memory: lstm", "device: cuda", ["3:18  network.macn: got device; expected --device on the command line."]),
    (
        "memory: lstm",
        "checkpoint: ./none.safetensors",
        [
            (
                "3:30  network.macn.checkpoint: got ./none.safetensors; "
                f"expected an existing file (looked for {Path('none.safetensors').absolute()})."
            ),
        ],
    ),
    (
        "memory: lstm",
        "checkpoint: mcan-grid",
        [
            (
                "3:30  network.macn.checkpoint: got mcan-grid; "
                f"expected a file that ends in .safetensors, or one of {CHECKPOINTS}. Did you mean macn-grid?"
            ),
        ],
    ),
    ("network: {macn: {memory: lstm}}\n", "", ["1:1  network: missing; give a mapping or text."]),
    ("blobs: {size: 16, ", "blobs: {", ["5:10  maps.blobs.size: missing; give a whole number from 2 to 4,096."]),
    (
        "  blobs:",
        "  blob:",
        [
            f"5:3  maps: got blob; expected {FAMILIES}. Did you mean blobs?",
            "16:25  variants.32x32.maps.blobs.obstacles: missing; give two whole numbers from 0 to 1,000,000.",
            "16:25  variants.32x32.maps.blobs.obstacle_size: missing; give two whole numbers from 1 to 1,000,000,000.",
        ],
    ),
    (
        "maps:\n",
        "map:\n",
        [
            "1:1  maps: missing; give a mapping.",
            f"4:1  got map; expected one of {KEYS}. Did you mean maps?",
            "16:25  variants.32x32.maps.blobs.obstacles: missing; give two whole numbers from 0 to 1,000,000.",
            "16:25  variants.32x32.maps.blobs.obstacle_size: missing; give two whole numbers from 1 to 1,000,000,000.",
        ],
    ),
    (
        "{obstacles: [2, 2]}",
        "{obstacle: [2, 2]}",
        [
            (
                "10:25  learning.imitation.curriculum.easy: got obstacle; "
                "expected one of size, obstacles, obstacle_size. Did you mean obstacles?"
            ),
        ],
    ),
    (
        "[2, 2]",
        "[3, 2]",
        ["10:36  learning.imitation.curriculum.easy.obstacles: got [3, 2]; expected two numbers, the smaller first."],
    ),
    (
        "[2, 2]",
        "few",
        [
            (
                "10:36  learning.imitation.curriculum.easy.obstacles: got few; "
                "expected two whole numbers from 0 to 1,000,000."
            ),
        ],
    ),
    ("{obstacles: [2, 2]}", "3", ["10:24  learning.imitation.curriculum.easy: got 3; expected a mapping."]),
    ("until: 0.3", "until: 3", ["10:52  learning.imitation.curriculum.until: got 3; expected a number from 0 to 1."]),
    (
        "share: [1, 0.1]",
        "share: 1",
        ["11:22  learning.imitation.teacher.share: got 1; expected two numbers from 0 to 1."],
    ),
    (
        "share: [1, 0.1]",
        "share: [1, 2]",
        ["11:26  learning.imitation.teacher.share[1]: got 2; expected a number from 0 to 1."],
    ),
    (
        "share: [1, 0.1]",
        "hindsight: 2",
        ["11:26  learning.imitation.teacher.hindsight: got 2; expected true or false."],
    ),
    (
        "batches: 100",
        "batches: 100\n    batch: 10001",
        ["13:12  learning.imitation.batch: got 10001; expected a whole number from 1 to 10,000."],
    ),
    (
        "batches: 100",
        "batches: 0",
        ["12:14  learning.imitation.batches: got 0; expected a whole number from 1 to 1,000,000,000."],
    ),
    (
        "batches: 100",
        "minutes: 3",
        [
            "10:5  learning.imitation.batches: missing; give a whole number from 1 to 1,000,000,000.",
            f"12:5  learning.imitation: got minutes; expected {LEARNING}.",
        ],
    ),
    (
        "adam",
        "adamw",
        ["13:16  learning.imitation.optimiser: got adamw; expected one of adam, rmsprop. Did you mean adam?"],
    ),
    (
        "rate: [1e-3, 1e-4]",
        "rate: 1e-3",
        ["14:11  learning.imitation.rate: got 1e-3; expected two numbers above 0 and up to 1,000."],
    ),
    (
        "rate: [1e-3, 1e-4]",
        "rate: [0, 1e-4]",
        ["14:12  learning.imitation.rate[0]: got 0; expected a number above 0 and up to 1,000."],
    ),
    (
        "size: 32",
        "size: many",
        ["16:32  variants.32x32.maps.blobs.size: got many; expected a whole number from 2 to 4,096."],
    ),
    (
        "32x32: {maps",
        "32x32: {agents: [astar], maps",
        ["16:11  variants.32x32: got agents; expected one of maps, kind, sensor, rules, tasks, budget."],
    ),
    ("radius: 3", "radius: 0", ["6:18  sensor.radius: got 0; expected a whole number from 1 to 1,024."]),
    (
        "radius: 3",
        "radius: ${FOG_NO}",
        ["6:19  got broken YAML (expected ',' or '}', but got '{'); expected one YAML document."],
    ),
    ("seed: 2", "seed: -1", ["17:7  seed: got -1; expected a whole number from 0 to 4,294,967,295."]),
    ("seed: 2", "lessons: 32x32", ["17:10  lessons: got 32x32; expected a list."]),
    ("seed: 2", "lessons: [{32x32: 1}]", ["17:11  lessons[0]: got {32x32: 1}; expected text."]),
    (
        "seed: 2",
        "lessons: [32x32, 32x23]",
        ["17:18  lessons[1]: got 32x23; expected one of 32x32. Did you mean 32x32?"],
    ),
    (
        "{blobs: {size: 32}}, budget: {steps: 60}}",
        "{tunnel: {length: [4, 9]}}}\nlessons: [32x32]",
        [
            (
                "10:25  learning.imitation.curriculum.easy: got obstacles; "
                f"expected one of {', '.join(Tunnel.model_fields)}."
            ),
        ],
    ),
    ("seed: 2", "episodes: 3", [f"17:1  got episodes; expected one of {KEYS}."]),
    (
        "seed: 2",
        "rate: [1e-3, 1e-4]",
        ["17:1  got rate; expected learning: {imitation: {rate: ...}}. Did you mean learning?"],
    ),
    (
        "  imitation:",
        "  imitatoin:",
        [f"9:3  learning: got imitatoin; expected {LEARNERS}. Did you mean imitation?"],
    ),
    ("budget: {steps: 40}\n", "", ["1:1  budget: missing; give a mapping."]),
    (
        "seed: 2",
        "validation: {every: 0}",
        ["17:21  validation.every: got 0; expected a whole number from 1 to 1,000,000,000."],
    ),
]


def test_the_recipe_is_read() -> None:
    """Where it learns, from what maps it starts, where it is tried, and how; the seed is the network's too."""
    recipe = read_recipe(GOOD, Path("r.yaml"))
    full = Blobs(size=16, obstacles=(0, 12), obstacle_size=(1, 3))
    assert recipe.name == "small"
    assert recipe.network == Macn(checkpoint="none", memory="lstm", seed=2)
    ((worlds, easy),) = recipe.lessons
    assert worlds.family == full
    assert worlds.conditions.budget.steps == 40
    assert easy == full.model_copy(update={"obstacles": (2, 2)})
    assert recipe.held_out.keys() == {"32x32"}
    assert recipe.held_out["32x32"].family == full.model_copy(update={"size": 32})
    assert recipe.held_out["32x32"].conditions.budget.steps == 60
    assert recipe.held_out["32x32"].conditions.sensor.radius == 3
    learning = cast(Imitation, recipe.learning)
    assert (learning.batches, learning.rate, recipe.seed) == (100, (1e-3, 1e-4), 2)
    assert learning.teacher == Teacher(share=(1, 0.1), until=0.25)


def test_little_has_to_be_said() -> None:
    """Without a curriculum all maps are full ones, and without variants the network is tried where it learns."""
    maps = "{blobs: {size: 8, obstacles: [0, 2], obstacle_size: [1, 2]}}"
    text = f"name: least\nnetwork: macn\nmaps: {maps}\nbudget: {{steps: 20}}\nlearning: {{imitation: {{batches: 3}}}}\n"
    recipe = read_recipe(text, Path("r.yaml"))
    ((worlds, easy),) = recipe.lessons
    assert easy == worlds.family
    assert recipe.held_out == {"all": worlds}


def test_lessons_are_variants() -> None:
    """Each has its variant's worlds, and begins with the easy settings over its own; one may stand there twice."""
    more = GOOD.replace("seed: 2", "  dense: {maps: {blobs: {obstacles: [9, 30]}}}\nlessons: [dense, 32x32, dense]")
    recipe = read_recipe(more, Path("r.yaml"))
    dense, large = (recipe.held_out[name] for name in ("dense", "32x32"))
    assert [lesson.worlds for lesson in recipe.lessons] == [dense, large, dense]
    for lesson in recipe.lessons:
        family = cast(Blobs, lesson.worlds.family)
        assert lesson.easy == family.model_copy(update={"obstacles": (2, 2)})


def test_a_variant_that_is_no_lesson_may_have_other_maps() -> None:
    """The easy settings need not fit what the network is only tried on."""
    text = GOOD.replace("{blobs: {size: 32}}", "{tunnel: {length: [4, 9]}}")
    assert read_recipe(text, Path("r.yaml")).held_out["32x32"].family == Tunnel(length=(4, 9))


@pytest.mark.parametrize(("old", "new", "lines"), BROKEN, ids=range(len(BROKEN)))
def test_each_mistake_is_told_at_its_place(old: str, new: str, lines: list[str]) -> None:
    """One line for each, with what was got, what was expected, and the nearest valid name."""
    assert GOOD.count(old) == 1
    with pytest.raises(ScenarioError) as caught:
        read_recipe(GOOD.replace(old, new), Path("r.yaml"))
    assert caught.value.lines == [f"r.yaml:{line}" for line in lines]


def test_a_network_whose_package_is_missing_is_no_skipped_row(tmp_path: Path) -> None:
    """In a scenario such an agent is skipped; a training cannot do without."""
    (tmp_path / "mine.py").write_text("import fog_lamp\n")
    with pytest.raises(ScenarioError) as caught:
        read_recipe(GOOD.replace("{macn: {memory: lstm}}", "./mine.py:Mine"), tmp_path / "r.yaml")
    missing = "needs the package fog_lamp, which is not installed"
    expected = f"expected a network that is installed; this one {missing}."
    assert caught.value.lines == [f"{tmp_path / 'r.yaml'}:3:10  network: got ./mine.py:Mine; {expected}"]


def test_a_variable_that_is_not_set_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """A recipe cannot be skipped like a scenario."""
    monkeypatch.delenv("FOG_RADIUS", raising=False)
    text = GOOD.replace("radius: 3", 'radius: "${FOG_RADIUS}"')
    with pytest.raises(Mistake) as caught:
        read_recipe(text, Path("r.yaml"))
    assert str(caught.value) == "r.yaml: got ${FOG_RADIUS}; expected that environment variable to be set."
    monkeypatch.setenv("FOG_RADIUS", "2")
    assert read_recipe(text, Path("r.yaml")).lessons[0].worlds.conditions.sensor.radius == 2
