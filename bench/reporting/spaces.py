"""How well the inputs, the plans and the scores of a network tell decisions apart: in a number, and by t-SNE."""

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from scipy.spatial.distance import cdist

from fogbench.bench.reporting.canvas import Figure
from fogbench.bench.reporting.panels import legend, look_of
from fogbench.bench.reporting.plain import folded
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import Array

PERPLEXITY = 30
"""Neighbours that t-SNE gives each point; where there are few points, a third of them."""


class Decisions(NamedTuple):
    """Decisions of a network that had one optimal move."""

    spaces: Mapping[str, Array]
    """By name, what each decision is in some space: [n, any]."""
    moves: Array
    """[n] int, the optimal move."""
    episodes: Array
    """[n] int, where each comes from."""
    names: Sequence[str]
    """What the moves are called."""

    def commonest(self) -> float:
        """The share of the commonest move: what a guess that sees nothing would reach."""
        return float(np.bincount(self.moves).max() / len(self.moves))

    def separable(self) -> dict[str, float]:
        """The separability of each space, by name."""
        return {name: separability(points, self.moves, self.episodes) for name, points in self.spaces.items()}


def separability(points: Array, labels: Array, groups: Array) -> float:
    """How often the nearest neighbour has the same label (leave-one-group-out accuracy of 1-NN).

    Points of a point's own group, such as the other decisions of an episode, are left out, for they are near because
    they follow each other. Of points that are equally near, each counts for its part.

    Args:
        points: [n, any].
        labels: [n].
        groups: [n], at least two different ones.

    Returns:
        A share from 0 to 1.
    """
    distances = cdist(points, points, "sqeuclidean")  # [n, n]
    distances[groups[:, None] == groups] = np.inf
    nearest = distances == distances.min(1, keepdims=True)
    alike = nearest & (labels[:, None] == labels)
    return float((alike.sum(1) / nearest.sum(1)).mean())


def embedded(points: Array) -> Array:
    """The points [n, any] in a plane [n, 2], by t-SNE (van der Maaten & Hinton 2008); the same bits every time.

    Raises:
        Mistake: scikit-learn is not installed.
    """
    try:
        from sklearn.manifold import TSNE  # noqa: PLC0415  an extra
    except ModuleNotFoundError:
        raise Mistake('t-SNE needs the extra learned: pip install ".[learned]"') from None
    neighbours = min(PERPLEXITY, (len(points) - 1) / 3)
    plane: Array = TSNE(perplexity=neighbours, random_state=0).fit_transform(np.asarray(points, np.float32))
    return plane


def spaces(planes: Iterable[tuple[str, Array, float]], decisions: Decisions, title: str) -> Figure:
    """A panel for each space, its points coloured by the optimal move, its separability in its title.

    Args:
        planes: name, points [n, 2] and separability of each.
        decisions: what the points are.
        title: one line or more.
    """
    planes, shown = list(planes), np.unique(decisions.moves).tolist()
    looks = {decisions.names[move]: look_of(move)._replace(linestyle="") for move in shown}
    figure = Figure(figsize=(3.2 * len(planes), 4.0), layout="constrained")
    panels = figure.subplots(1, len(planes), squeeze=False).flat
    for axes, (name, points, separable) in zip(panels, planes, strict=True):
        for move, look in zip(shown, looks.values(), strict=True):
            x, y = points[decisions.moves == move].T
            axes.scatter(x, y, s=9, color=look.color, marker=look.marker, alpha=0.6, linewidths=0)
        axes.set(xticks=[], yticks=[], title=f"{name}: {100 * separable:.1f} %")
    legend(figure, looks, lines=False)
    figure.supxlabel("\n".join(folded(line, 50 * len(planes)) for line in title.split("\n")), fontsize="medium")
    return figure
