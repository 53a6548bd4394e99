"""The figure of what a memory holds."""

import numpy as np
import pytest

from fogbench.bench.reporting.activations import activations, changes, table

MEMORY = np.array([[3.0, 4], [3, 4], [0, 0], [0, -2]])
"""Of two numbers, after four steps."""

WRITTEN = np.array([[1.0], [0], [0], [0.5]])

PARTS = {"memory": MEMORY, "written": WRITTEN}


def test_changes_by_hand() -> None:
    """The first is from zero; what stays does not change."""
    assert changes(MEMORY).tolist() == [5, 0, 5, 2]


def test_a_table_says_how_far_each_part_moves() -> None:
    """At the median step, and at each that is marked; without marks at the median step alone."""
    marked = table(PARTS, {"turn": 2, "exit": 3})
    assert marked.headings == ["change of", "median step", "turn (step 2)", "exit (step 3)"]
    assert marked.rows == [["memory", "3.5", "5", "2"], ["written", "0.75", "0", "0.5"]]
    assert table(PARTS, {}) == (["change of", "median step"], [["memory", "3.5"], ["written", "0.75"]])


@pytest.mark.parametrize("marks", [{"turn": 2, "exit": 3}, {}], ids=["marked", "unmarked"])
def test_a_map_for_each_part_and_the_change_below(marks: dict[str, int]) -> None:
    """Numbers stand where they are held, the steps are marked in every panel and named once."""
    figure = activations(PARTS, marks, "by hand")
    memory, written, below = figure.axes[:3]
    assert np.array_equal(memory.images[0].get_array(), MEMORY.T)
    assert np.array_equal(written.images[0].get_array(), WRITTEN.T)
    assert (memory.images[0].get_clim(), written.images[0].get_clim()) == ((-4, 4), (0, 1))
    assert (memory.get_title(loc="left"), memory.get_ylabel(), written.get_ylabel()) == ("by hand", "memory", "written")
    assert [line.get_ydata().tolist() for line in below.lines[:2]] == [[5, 0, 5, 2], [1, 1, 0, 0.5]]
    for drawn in (memory.lines, written.lines, below.lines[2:]):
        assert [line.get_xdata()[0] for line in drawn] == list(marks.values())
    named = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    assert named == [f"{name} (step {step})" for name, step in marks.items()]


def test_marks_of_one_step_are_one_line() -> None:
    """A line over another would hide it."""
    figure = activations(PARTS, {"end wall": 2, "turn": 2, "exit": 3}, "by hand")
    assert [line.get_xdata()[0] for line in figure.axes[0].lines] == [2, 3]
    named = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    assert named == ["end wall and turn (step 2)", "exit (step 3)"]
