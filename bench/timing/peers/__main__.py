"""How fast we are beside others: the same work in rounds that take turns, and the ratio of each round.

    python bench/timing/peers POGEMA_PYTHON        (`tox -e peers` makes both environments and runs this)

A round of ours and the next one of theirs meet the same load of the machine, so their ratio means something where the
two figures alone do not. Episodes and searches run on one thread, in CPU seconds of the process that does the work;
the networks' inner loops on two, by the wall clock. Said are the medians; beside the ratio, how many times as fast ours
is, its least and its most.
"""

import sys

from driving import drives
from iterating import iterations
from remembering import memories
from rich.console import Console
from rich.table import Table
from searching import searches
from turns import Turns
from walking import walks
from wandering import wanders


def main() -> None:
    """Run all comparisons and print one table."""
    table = Table("work", "peer", "ours", "theirs", "ratio", "least to most", title="Beside others")
    for turns in (*walks(sys.argv[1]), *wanders(), *drives(), *searches(), *iterations(), *memories()):
        table.add_row(*cells(turns))
    Console().print(table)


def cells(turns: Turns) -> tuple[str, ...]:
    """A row of the table."""
    ratio, least, most = turns.ratio()
    figures = (turns.figure(seconds) for seconds in (turns.ours, turns.theirs))
    return turns.work, turns.peer, *figures, f"{ratio:.2f}", f"{least:.2f} to {most:.2f}"


main()
