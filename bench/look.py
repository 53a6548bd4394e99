"""From recorded episodes of a network to figures of what goes on in it."""

from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import partial
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, cast

import numpy as np
import pandas as pd
from rich.console import Console
from rich.progress import track
from threadpoolctl import threadpool_limits

from fogbench.bench.playing.loop import episode_stream, episode_world
from fogbench.bench.playing.provenance import differences
from fogbench.bench.playing.replay import Moment, retrace
from fogbench.bench.playing.selection import chosen_row, chosen_rows, chosen_variant
from fogbench.bench.reading.scenario import Scenario, Variant
from fogbench.bench.reading.tables import NETWORK
from fogbench.bench.reading.variant import Entry
from fogbench.bench.reporting.activations import activations, table
from fogbench.bench.reporting.canvas import draw
from fogbench.bench.reporting.plain import plain, stems
from fogbench.bench.reporting.spaces import Decisions, embedded, spaces
from fogbench.bench.reporting.tables import markdown
from fogbench.planners import judge_of
from fogbench.worlds.mistake import Mistake, counted, meant, near
from fogbench.worlds.types import Marked

if TYPE_CHECKING:
    from fogbench.learned.glimpse import Glimpse

Item = TypeVar("Item")

EPISODES, DECISIONS = 100, 2000
"""The most that t-SNE is shown."""

PLANNED = "planning module"
"""The name of what a network makes of its image before it remembers anything."""

LEAST = 10
"""Decisions that t-SNE needs."""


def look_inside(scenario: Scenario, variant_name: str | None, agent: str, episode: int, folder: Path) -> str:
    """Draw what a network makes of what it saw in its recorded episodes, and what it remembered in one of them.

    Its decisions are taken again, one by one, and held against the record.

    Returns:
        What was found, for each figure, and how the packages differ from those that it was played with, if they do.

    Raises:
        Mistake: there is no such network or episode, or it decides otherwise than recorded.
    """
    variant = chosen_variant(scenario, variant_name)
    entry = _network(variant, agent)
    row = chosen_row(scenario, variant, agent, episode, folder)
    rows = chosen_rows(scenario, variant, agent, folder).head(EPISODES)
    names = [f"{each.name} {one.label}" for each in scenario.variants for one in each.agents]
    end = f"{stems(names)[f'{variant.name} {agent}']}.png"
    with threadpool_limits(1):  # as it was played
        figures = (
            _memory(variant, entry, row, folder / f"memory-{end}"),
            _spaces(variant, entry, rows, folder / f"tsne-{end}"),
        )
    return "\n".join(filter(None, [*figures, differences(folder, scenario)]))


def _network(variant: Variant, label: str) -> Entry:
    """The agent of a label."""
    agents = {entry.label: entry for entry in variant.agents}
    networks = [name for name, entry in agents.items() if all(hasattr(entry.settings, own) for own in NETWORK.members)]
    if label in networks:
        return agents[label]
    expected = (
        f"one of the networks {', '.join(networks)}"
        if networks
        else "a class derived from Policy, as docs/extending.md tells; none plays here"
    )
    if label in agents:
        why = f"is skipped ({agents[label].skipped})" if agents[label].skipped else "is not a network of fogbench"
        raise Mistake(f"--agent: got {label}, which {why}; expected {expected}.")
    raise Mistake(f"--agent: got {label}; expected {expected}.{meant(near(label, networks))}")


def _watch(variant: Variant, entry: Entry, row: Mapping[str, Any]) -> Iterator[tuple[Moment, "Glimpse"]]:
    """The moments of a recorded episode with the decision that is taken at each; what it holds is overwritten."""
    from fogbench.learned.glimpse import glimpse  # noqa: PLC0415  it loads PyTorch, which a wrong option need not

    assert entry.settings is not None
    episode = int(row["episode"])
    agent: Any = entry.settings.start(episode_world(variant, episode).task, episode_stream(variant, "agent", episode))
    for moment in islice(retrace(variant, row), int(row["steps"])):  # after a last one nothing was decided
        seen = glimpse(agent, moment.observation)
        if seen.action != moment.action:
            raise Mistake(
                f"episode {episode} of {entry.label} in variant {variant.name}: got {_called(seen.action)} at step "
                f"{moment.observation.step}; expected {_called(moment.action)}, as recorded (on another machine?)."
            )
        yield moment, seen


def _called(action: Any) -> str:
    """An action in a line of text: the name of one that has a name."""
    return str(getattr(action, "name", action))


def _memory(variant: Variant, entry: Entry, row: Mapping[str, Any], out: Path) -> str:
    """Draw what is remembered along an episode."""
    watched = [(moment, seen.held) for moment, seen in _watch(variant, entry, row)]
    told = plain(f"{entry.label} in variant {variant.name}, episode {row['episode']}")
    if not watched:
        return f"{told}: no decision is recorded, so there is no figure of its memory."
    if not watched[0][1]:
        return f"{told}: it remembers nothing, so there is no figure of its memory."
    parts = {name: np.array([held[name] for _, held in watched]) for name in watched[0][1]}  # [T, any] each
    last = watched[-1][0]
    marks = variant.family.moments(last.world, last.path) if isinstance(variant.family, Marked) else {}
    draw(partial(activations, parts, marks, told), out)
    return f"{told}. Drawn in {out}\n\n{markdown(table(parts, marks))}"


def _spaces(variant: Variant, entry: Entry, rows: pd.DataFrame, out: Path) -> str:
    """Draw how the decisions of some episodes lie in what the network is shown, in its plans and in its scores."""
    teacher = judge_of(variant.kind)
    if teacher is None:
        return f"No t-SNE of {plain(variant.name)}: no judge says what is right in worlds of kind {variant.kind}."
    decisions = _decisions(variant, entry, rows, teacher)
    told = (
        f"{len(decisions.moves)} decisions with one optimal move, in {counted(len(set(decisions.episodes)), 'episode')}"
    )
    if len(decisions.moves) < LEAST or len(set(decisions.episodes)) < 2:
        return f"No t-SNE of {told}; expected {LEAST} or more, in two or more: `fogbench run --episodes` records them."
    separable = decisions.separable()
    planes = [(name, embedded(points), separable[name]) for name, points in _tracked(decisions.spaces.items(), "t-SNE")]
    told = plain(f"{entry.label} in variant {variant.name}: {told}")
    chance = f"always the commonest move: {100 * decisions.commonest():.1f} %"
    meaning = f"Panel title: nearest-neighbour accuracy ({chance})"
    draw(partial(spaces, planes, decisions, f"{told}\n{meaning}"), out)
    found = ", ".join(f"{name} {100 * share:.1f} %" for name, share in separable.items())
    lacking = "" if PLANNED in separable else f". The network has no `plan`: no panel of a {PLANNED}"
    return f"{told}. Nearest-neighbour accuracy: {found} ({chance}). Drawn in {out}{lacking}"


def _decisions(variant: Variant, entry: Entry, rows: pd.DataFrame, teacher: Any) -> Decisions:
    """Every decision, or every so many, that had one optimal move on the agent's own known map, by its judge."""
    every = max(1, -(-int(rows["steps"].sum()) // DECISIONS))
    kept, count = list[tuple["Glimpse", int, int]](), 0
    for row in _tracked(cast(list[dict[str, Any]], rows.to_dict("records")), "replaying"):
        judge = teacher(episode_world(variant, row["episode"]).task)
        for moment, seen in _watch(variant, entry, row):
            judge.see(moment.observation)
            right = np.asarray(judge.targets())  # [A]
            if right.sum() == 1 and count % every == 0:
                kept.append((seen, int(right.argmax()), row["episode"]))
            count += 1
    shown = {
        "raw image": [seen.image for seen, _, _ in kept],
        PLANNED: [seen.planned for seen, _, _ in kept if seen.planned is not None],
        "scores of the moves": [seen.scores for seen, _, _ in kept],
    }
    moves, episodes = (np.array([each[k] for each in kept], np.int64) for k in (1, 2))
    names = kept[0][0].outputs if kept else ()
    return Decisions({name: np.array(points) for name, points in shown.items() if points}, moves, episodes, names)


def _tracked(items: Collection[Item], doing: str) -> Iterable[Item]:
    """The items, with a progress bar while they are worked on."""
    console = Console()
    return track(items, doing, console=console, transient=True, disable=not console.is_terminal)
