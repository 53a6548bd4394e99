"""Maps that grow from easy to full."""

from learned.curriculum import eased
from worlds.blobs import Blobs
from worlds.tunnel import Tunnel

EASY = Blobs(size=32, obstacles=(2, 2), obstacle_size=(1, 2))
FULL = Blobs(size=32, obstacles=(0, 30), obstacle_size=(1, 5))


def test_numbers_grow_in_step() -> None:
    """At the ends stand the two families; in between each number is as far on its way, rounded."""
    assert eased(EASY, FULL, 0) == EASY
    assert eased(EASY, FULL, 0.5) == Blobs(size=32, obstacles=(1, 16), obstacle_size=(1, 4))
    assert eased(EASY, FULL, 1) is FULL


def test_words_change_at_the_end() -> None:
    """What is no number stays easy until the full family; fractions grow without being rounded."""
    easy, full = Tunnel(length=(4, 4), goal="inside"), Tunnel(length=(4, 20), open=0.5)
    assert eased(easy, full, 0.5) == Tunnel(length=(4, 12), open=0.25, goal="inside")
    assert eased(easy, full, 1) == full
