"""How well a space tells decisions apart, and the figure of it."""

import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fogbench.bench.reporting.spaces import Decisions, embedded, separability, spaces
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import Array

CLUSTERS = np.array([[0.0, 0], [0, 1], [1, 0], [1, 1], [9, 9], [9, 8], [8, 9], [8, 8]])
"""Two of four points each."""

LEFT = np.array([0, 0, 0, 0, 3, 3, 3, 3])
TURNS = np.array([0, 1, 0, 1, 0, 1, 0, 1])
NAMES = ("down", "right", "up", "left")


def test_two_clusters_are_separable() -> None:
    """All neighbours agree if the labels are those of the clusters, and none if they are those of the episodes."""
    assert separability(CLUSTERS, LEFT, TURNS) == 1
    assert separability(CLUSTERS, TURNS, TURNS) == 0


def test_equal_points_count_for_their_part() -> None:
    """Three equal points in three episodes: the first two agree with one of two others, the last with none."""
    assert separability(np.zeros((3, 2)), np.array([1, 1, 2]), np.arange(3)) == pytest.approx((0.5 + 0.5 + 0) / 3)


def test_the_next_decision_of_an_episode_is_no_neighbour() -> None:
    """What follows each other is near and alike; that says nothing of other episodes."""
    points, labels = np.array([[0.0], [0.1], [5], [5.1]]), np.array([0, 0, 1, 1])
    assert separability(points, labels, np.array([0, 0, 1, 1])) == 0
    assert separability(points, labels, np.array([0, 1, 0, 1])) == 1


def plain(points: Array, labels: Array, groups: Array) -> float:
    """Separability in plain loops."""
    shares = []
    for i in range(len(points)):
        others = [j for j in range(len(points)) if groups[j] != groups[i]]
        far = {j: int(((points[i] - points[j]) ** 2).sum()) for j in others}
        nearest = [j for j in others if far[j] == min(far.values())]
        shares.append(sum(int(labels[j] == labels[i]) for j in nearest) / len(nearest))
    return sum(shares) / len(shares)


@given(st.lists(st.tuples(*[st.integers(0, 3)] * 4), min_size=1, max_size=12))
def test_separability_is_that_of_plain_loops(rows: list[tuple[int, ...]]) -> None:
    """For any points, labels and groups, with many that are equal."""
    table = np.array([*rows, (0, 0, 0, 9)])  # a group of its own: there are always two
    points, labels, groups = table[:, :2], table[:, 2], table[:, 3]
    assert separability(points, labels, groups) == pytest.approx(plain(points, labels, groups))


def test_decisions_know_the_commonest_move() -> None:
    """It is what a guess would reach; every space has its number."""
    decisions = Decisions({"near": CLUSTERS, "same": 0 * CLUSTERS}, np.array([0, 0, 0, 0, 3, 3, 3, 0]), TURNS, NAMES)
    assert decisions.commonest() == 5 / 8
    assert list(decisions.separable()) == ["near", "same"]


def test_a_plane_repeats_and_keeps_clusters() -> None:
    """The same bits again; points of a cluster stay beside each other."""
    points = np.concatenate([np.random.default_rng(0).normal(centre, 1, (12, 5)) for centre in (0, 100)])
    plane = embedded(points)
    assert plane.shape == (24, 2)
    assert np.array_equal(plane, embedded(points))
    assert separability(plane, np.arange(24) // 12, np.arange(24)) == 1


def test_a_panel_shows_its_points_by_move() -> None:
    """The title has the number, the legend the moves that there are, and each point is drawn once."""
    figure = spaces(
        [("raw image", CLUSTERS, 0.5), ("scores", CLUSTERS + 1, 1.0)],
        Decisions({}, LEFT, TURNS, NAMES),
        "eight decisions",
    )
    first, second = figure.axes
    assert [axes.get_title() for axes in figure.axes] == ["raw image: 50.0 %", "scores: 100.0 %"]
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["down", "left"]
    assert np.array_equal(np.concatenate([dots.get_offsets() for dots in first.collections]), CLUSTERS)
    assert np.array_equal(np.concatenate([dots.get_offsets() for dots in second.collections]), CLUSTERS + 1)


def test_without_scikit_learn_one_line_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is in the extra of the networks."""
    monkeypatch.setitem(sys.modules, "sklearn.manifold", None)
    with pytest.raises(Mistake) as caught:
        embedded(CLUSTERS)
    assert str(caught.value) == 't-SNE needs the extra learned: pip install ".[learned]"'
