"""Replays of recorded episodes, and the pictures that are drawn of them."""

from collections.abc import Callable
from copy import deepcopy
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from fogbench.bench.drawing import AGENT, COLOURS, GOAL, PATH, SIDE, known, truth
from fogbench.bench.film import film, strip
from fogbench.bench.playing.play import lost, play
from fogbench.bench.playing.replay import End, Moment, retrace, verify
from fogbench.bench.reading.scenario import Scenario, Variant
from fogbench.bench.reading.variant import Entry
from fogbench.planners.astar import AStar
from fogbench.planners.memoryless import Memoryless
from fogbench.planners.random_walk import RandomWalk
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.picture import Picture
from fogbench.worlds.types import BLOCKED, FREE, UNKNOWN, Outcome

Row = dict[str, Any]

NOISE = {"false_readings": 0.1, "slip": 0.2, "slip_to": "sideways", "radius": 2}
SMALL = "S.. .#. ..G"

NAMES = {"agent": AGENT, "goal": GOAL}
"""What some colours stand for."""


@pytest.fixture
def scenario(conditions: Callable[..., Any]) -> Callable[..., Scenario]:
    """Makes a scenario of one variant: a family, one agent, and the fields of the conditions."""

    def make(family: Any, settings: Any, **fields: Any) -> Scenario:
        entry = Entry("agent", "", settings, "")
        variant = Variant("row", "grid", family, conditions(**fields), (entry,), "agent", episodes=100, seed=0)
        return Scenario(Path(), "", "hand-made", "", (variant,), {}, "")

    return make


def record(scenario: Scenario, episode: int) -> Row:
    """The row of a played episode."""
    (variant,) = scenario.variants
    return asdict(play(scenario, variant, variant.agents[0], episode, workers=1))


def replayed(scenario: Scenario, episode: int, actions: Any) -> tuple[list[Moment], End]:
    """Every moment of a replay, and its end."""
    row = {"episode": episode, "steps": len(actions), "actions": actions}
    moments, kept = retrace(scenario.variants[0], row), []
    while True:
        try:
            moment = next(moments)
        except StopIteration as stop:
            return kept, stop.value
        kept.append(moment._replace(known=deepcopy(moment.known), path=list(moment.path)))


def test_recorded_episodes_of_every_outcome_replay(scenario: Callable[..., Scenario]) -> None:
    """With noise, slips and all ways to end, the same steps over the same length end in the same way."""
    maps = Blobs(size=8, obstacles=(3, 9), obstacle_size=(1, 3))
    seen = set()
    for settings, budget in ((AStar(), None), (Memoryless(), None), (RandomWalk(), None), (AStar(), 1)):
        made = scenario(maps, settings, memory_bytes=budget, steps=15, **NOISE)
        for episode in range(12):
            row = record(made, episode)
            moments, end = replayed(made, episode, row["actions"])
            verify(row, end)
            assert len(moments) == row["steps"] + 1
            seen.add(row["outcome"])
    assert seen == {"REACHED", "COLLIDED", "GAVE_UP", "OUT_OF_STEPS", "OUT_OF_MEMORY"}


def test_a_lost_episode_replays_to_its_start(scenario: Callable[..., Scenario]) -> None:
    """An episode that hung or died left no actions: what is replayed is the first look."""
    made = scenario(Blobs(size=8, obstacles=(3, 9), obstacle_size=(1, 3)), AStar())
    (variant,) = made.variants
    for outcome in (Outcome.HUNG, Outcome.CRASHED):
        row = asdict(lost(made, variant, variant.agents[0], 0, 1, outcome, ""))
        moments, end = replayed(made, 0, row["actions"])
        verify(row, end)
        assert len(moments) == 1


@pytest.mark.parametrize(
    ("actions", "told"),
    [
        ((0.0, 0.0, 1.0, 3.0), "4 steps over 4 and did not reach the goal"),
        ((0.0, 0.0, 1.0), "3 steps over 3 and did not reach the goal"),
        ((0.0, 1.0, 0.0, 1.0), "4 steps over 3 and did not reach the goal"),
        ((0.0, 2.0, 0.0, 0.0, 1.0, 1.0), "6 steps over 6 and reached the goal"),
    ],
)
def test_altered_actions_are_refused(
    scenario: Callable[..., Scenario], picture: Callable[[str], Any], actions: tuple[float, ...], told: str
) -> None:
    """A replay that does not end as recorded is a mistake that tells both ends in one line."""
    made = scenario(picture(SMALL), AStar())
    row = record(made, 7)
    assert row["actions"] == (0.0, 0.0, 1.0, 1.0)
    _, end = replayed(made, 7, actions)
    with pytest.raises(Mistake) as caught:
        verify(row, end)
    assert str(caught.value) == (
        f"episode 7 of agent in row: the replay took {told}; recorded are 4 steps over 4 and REACHED."
    )


@pytest.mark.parametrize(("outcome", "collided"), [("COLLIDED", False), ("OUT_OF_STEPS", True), ("REACHED", False)])
def test_another_outcome_is_refused(outcome: str, collided: bool) -> None:
    """Equal steps and lengths are not enough: the goal and a collision must be found where they are recorded."""
    row = {"episode": 0, "agent": "a", "variant": "v", "steps": 2, "length": 1.0, "outcome": outcome}
    with pytest.raises(Mistake, match=f"recorded are 2 steps over 1 and {outcome}"):
        verify(row, End(2, 1.0, reached=False, collided=collided))


@pytest.fixture
def moments(scenario: Callable[..., Scenario], picture: Callable[[str], Any]) -> list[Moment]:
    """A short walk: down, down, into the border, right."""
    made = scenario(picture(SMALL), AStar(), collision="blocked")
    return replayed(made, 0, (0.0, 0.0, 0.0, 1.0))[0]


def pictures(moments: list[Moment]) -> list[Picture]:
    """What some moments look like."""
    return [moment.picture() for moment in moments]


def test_moments_follow_the_agent(moments: list[Moment]) -> None:
    """Each moment has its look, the path up to it, and the known map with its look in it."""
    assert [moment.observation.place for moment in moments] == [(0, 0), (1, 0), (2, 0), (2, 0), (2, 1)]
    assert [moment.observation.blocked for moment in moments] == [False, False, False, True, False]
    assert moments[3].path == [(0, 0), (1, 0), (2, 0), (2, 0)]
    first, last = moments[0].known.cells.tolist(), moments[-1].known.cells.tolist()
    assert first == [[FREE, FREE, UNKNOWN], [FREE, BLOCKED, UNKNOWN], [UNKNOWN] * 3]
    assert last == [[FREE, FREE, UNKNOWN], [FREE, BLOCKED, FREE], [FREE, FREE, FREE]]


def test_pictures_show_every_cell(moments: list[Moment]) -> None:
    """The known map in its three colours, the truth with the view tinted, and path, goal and agent over both."""
    unknown, free, blocked = map(tuple, COLOURS.tolist())

    def tinted(colour: tuple[int, ...]) -> tuple[int, ...]:
        return tuple(int(0.6 * a + 0.4 * b) for a, b in zip(colour, (86, 180, 233), strict=True))

    assert [[tuple(cell) for cell in row] for row in known(moments[1].picture()).tolist()] == [
        [PATH, free, unknown],
        [AGENT, blocked, unknown],
        [free, free, GOAL],
    ]
    assert [[tuple(cell) for cell in row] for row in truth(moments[1].picture()).tolist()] == [
        [PATH, tinted(free), free],
        [AGENT, tinted(blocked), free],
        [tinted(free), tinted(free), GOAL],
    ]


def test_only_what_the_sensor_shows_is_tinted(scenario: Callable[..., Scenario], picture: Callable[[str], Any]) -> None:
    """With occlusion the cells behind a wall stay as they are, though they are within the radius."""
    made = scenario(picture("S#. ... ..G"), AStar(), radius=2, occlusion=True)
    (moment,), _ = replayed(made, 0, ())
    hidden = moment.observation.view[2:, 2:] == UNKNOWN  # [3, 3]
    plain = COLOURS[np.where(moment.world.blocked, BLOCKED, FREE)]  # [3, 3, RGB]
    untouched = (truth(moment.picture()) == plain).all(-1)  # [3, 3]
    untouched[2, 2] = hidden[2, 2]  # the goal is drawn over it
    assert hidden.any()
    assert (untouched == hidden).all()


def test_marks_on_large_maps_are_large(scenario: Callable[..., Scenario], picture: Callable[[str], Any]) -> None:
    """Of 120 rows, agent and goal reach two cells around theirs, as far as the map does."""
    rows = [f"S{'.' * 59}", *["." * 60] * 118, f"{'.' * 59}G"]
    (moment,), _ = replayed(scenario(picture(" ".join(rows)), AStar()), 0, ())
    drawn = known(moment.picture())
    assert np.argwhere((drawn == AGENT).all(-1)).tolist() == [[r, c] for r in range(3) for c in range(3)]
    assert np.argwhere((drawn == GOAL).all(-1)).tolist() == [[r, c] for r in (117, 118, 119) for c in (57, 58, 59)]


def test_a_strip_is_as_high_as_its_maps(tmp_path: Path) -> None:
    """A map half as high as wide takes half the height."""
    flat = np.zeros((5, 10, 3), np.uint8)
    strip([(flat, flat, 0)], NAMES, "a title", tmp_path / "strip.png")
    with Image.open(tmp_path / "strip.png") as image:
        assert image.size == (528, 355)


def test_a_strip_is_a_a_picture(moments: list[Moment], tmp_path: Path) -> None:
    """A PNG that is as wide as it has moments, of two at least."""
    for count in (1, 4):
        strip(
            [(truth(p), known(p), n) for n, p in enumerate(pictures(moments[:count]))],
            NAMES,
            "a title",
            tmp_path / "strip.png",
        )
        with Image.open(tmp_path / "strip.png") as image:
            image.load()
            assert (image.format, image.size) == ("PNG", (264 * max(2, count), 619))


def test_a_film_shows_every_step(moments: list[Moment], tmp_path: Path) -> None:
    """A GIF of 80 ms a step, the truth beside the known map; a step that changes nothing prolongs its frame."""
    film([(truth(p), known(p), n) for n, p in enumerate(pictures(moments))], NAMES, tmp_path / "film.gif")
    scale = SIDE // 3
    with Image.open(tmp_path / "film.gif") as image:
        assert (image.format, image.size) == ("GIF", (7 * scale, 3 * scale + 18))
        assert image.n_frames == 4
        lasts, agents = [], []
        for frame in range(image.n_frames):
            image.seek(frame)
            lasts.append(image.info["duration"])
            cells = np.asarray(image.convert("RGB"))[scale // 2 : 3 * scale : scale, scale // 2 :: scale]  # [3, 7, RGB]
            agents.append(np.argwhere((cells == AGENT).all(-1)).tolist())
    assert lasts == [80, 80, 160, 80]
    assert agents == [[[r, c], [r, c + 4]] for r, c in ((0, 0), (1, 0), (2, 0), (2, 1))]
