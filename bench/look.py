"""From recorded episodes of a network to figures of what goes on in it."""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, cast

import numpy as np
import pandas as pd
from rich.console import Console
from rich.progress import track
from threadpoolctl import threadpool_limits

from fogbench.bench.playing.loop import episode_stream, episode_world
from fogbench.bench.playing.milestones import milestones
from fogbench.bench.playing.replay import Moment, retrace
from fogbench.bench.playing.selection import chosen_row, chosen_rows, chosen_variant
from fogbench.bench.reading.scenario import Entry, Scenario, Variant
from fogbench.bench.reading.tables import NETWORK
from fogbench.bench.reporting.activations import activations, table
from fogbench.bench.reporting.spaces import Decisions, embedded, spaces
from fogbench.bench.reporting.tables import markdown
from fogbench.planners.optimal import OptimalMoves
from fogbench.worlds.mistake import Mistake, meant, near
from fogbench.worlds.types import Move

if TYPE_CHECKING:
    from fogbench.learned.glimpse import Glimpse

Item = TypeVar("Item")

EPISODES, DECISIONS = 100, 2000
"""The most that t-SNE is shown."""

LEAST = 10
"""Decisions that t-SNE needs."""


def look_inside(scenario: Scenario, variant_name: str | None, agent: str, episode: int, folder: Path) -> str:
    """Draw what a network makes of what it saw in its recorded episodes, and what it remembered in one of them.

    Its decisions are taken again, one by one, and held against the record.

    Returns:
        What was found, for each figure.

    Raises:
        Mistake: there is no such network or episode, or it decides otherwise than recorded.
    """
    variant = chosen_variant(scenario, variant_name)
    entry = _network(variant, agent)
    row = chosen_row(scenario, variant, agent, episode, folder)
    rows = chosen_rows(scenario, variant, agent, folder).head(EPISODES)
    end = "-".join(re.findall(r"\w+", f"{variant.name} {agent}")) + ".png"
    with threadpool_limits(1):  # as it was played
        return "\n".join([
            _memory(variant, entry, row, folder / f"memory-{end}"),
            _spaces(variant, entry, rows, folder / f"tsne-{end}"),
        ])  # fmt: skip


def _network(variant: Variant, label: str) -> Entry:
    """The agent of a label."""
    agents = {entry.label: entry for entry in variant.agents}
    networks = [name for name, entry in agents.items() if all(hasattr(entry.settings, own) for own in NETWORK.members)]
    if label in networks:
        return agents[label]
    expected = f"one of the networks {', '.join(networks)}" if networks else "a network, and there is none that plays"
    if label in agents:
        why = f"is skipped ({agents[label].skipped})" if agents[label].skipped else "is no network"
        raise Mistake(f"--agent: got {label}, which {why}; expected {expected}.")
    raise Mistake(f"--agent: got {label}; expected {expected}.{meant(near(label, networks))}")


def _watch(variant: Variant, entry: Entry, row: Mapping[str, Any]) -> Iterator[tuple[Moment, "Glimpse"]]:
    """The moments of a recorded episode with the decision that is taken at each; what it holds is overwritten."""
    from fogbench.learned.glimpse import glimpse  # noqa: PLC0415  it loads PyTorch, which a wrong option need not

    assert entry.settings is not None
    episode, actions = int(row["episode"]), row["actions"]
    agent: Any = entry.settings.start(episode_world(variant, episode).task, episode_stream(variant, "agent", episode))
    for moment, action in zip(retrace(variant, episode, actions), actions, strict=False):  # a last one, undecided
        seen = glimpse(agent, moment.observation)
        if seen.action != action:
            raise Mistake(
                f"episode {episode} of {entry.label} in {variant.name}: got {seen.action.name} at step "
                f"{moment.observation.step}; expected {Move(int(action)).name}, as recorded (on another machine?)."
            )
        yield moment, seen


def _memory(variant: Variant, entry: Entry, row: Mapping[str, Any], out: Path) -> str:
    """Draw what is remembered along an episode."""
    watched = [(moment, seen.held) for moment, seen in _watch(variant, entry, row)]
    told = f"{entry.label} in {variant.name}, episode {row['episode']}"
    if not watched:
        return f"{told}: no decision is recorded, so there is no figure of its memory."
    if not watched[0][1]:
        return f"{told}: it remembers nothing, so there is no figure of its memory."
    parts = {name: np.array([held[name] for _, held in watched]) for name in watched[0][1]}  # [T, any] each
    last = watched[-1][0]
    marks = milestones(variant.family, last.world, last.path)
    activations(parts, marks, told).savefig(out, dpi=200)
    return f"{told}. Drawn in {out}\n\n{markdown(table(parts, marks))}"


def _spaces(variant: Variant, entry: Entry, rows: pd.DataFrame, out: Path) -> str:
    """Draw how the decisions of some episodes lie in what the network is shown, in its plans and in its scores."""
    decisions = _decisions(variant, entry, rows)
    told = f"{len(decisions.moves)} decisions with one optimal move, in {len(set(decisions.episodes))} episodes"
    if len(decisions.moves) < LEAST or len(set(decisions.episodes)) < 2:
        return f"No t-SNE of {told}; expected {LEAST} or more, in two or more: `fogbench run --episodes` records them."
    separable = decisions.separable()
    planes = [(name, embedded(points), separable[name]) for name, points in _tracked(decisions.spaces.items(), "t-SNE")]
    told = f"{entry.label} in {variant.name}: {told}"
    chance = f"the commonest move: {100 * decisions.commonest():.1f} %"
    meaning = f"Over each: how often the nearest decision of another episode has the same optimal move ({chance})"
    spaces(planes, decisions.moves, f"{told}\n{meaning}").savefig(out, dpi=200)
    found = ", ".join(f"{name} {100 * share:.1f} %" for name, share in separable.items())
    return f"{told}. The nearest of another episode has the same optimal move: {found} ({chance}). Drawn in {out}"


def _decisions(variant: Variant, entry: Entry, rows: pd.DataFrame) -> Decisions:
    """Every decision, or every so many, that had one optimal move on the agent's own known map."""
    every = max(1, -(-int(rows["steps"].sum()) // DECISIONS))
    kept, count = list[tuple["Glimpse", int, int]](), 0
    for row in _tracked(cast(list[dict[str, Any]], rows.to_dict("records")), "replaying"):
        optimal = OptimalMoves(episode_world(variant, row["episode"]).task)
        for moment, seen in _watch(variant, entry, row):
            observation = moment.observation
            moves = optimal.update(moment.known, observation.place, len(observation.view) // 2)  # [4]
            if moves.sum() == 1 and count % every == 0:
                kept.append((seen, int(moves.argmax()), row["episode"]))
            count += 1
    shown = {
        "raw image": [seen.image for seen, _, _ in kept],
        "planning module": [seen.planned for seen, _, _ in kept],
        "scores of the moves": [seen.scores for seen, _, _ in kept],
    }
    moves, episodes = (np.array([each[k] for each in kept], np.int64) for k in (1, 2))
    return Decisions({name: np.array(points) for name, points in shown.items()}, moves, episodes)


def _tracked(items: Collection[Item], doing: str) -> Iterable[Item]:
    """The items, with a progress bar while they are worked on."""
    console = Console()
    return track(items, doing, console=console, transient=True, disable=not console.is_terminal)
