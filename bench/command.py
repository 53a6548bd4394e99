"""The command line. Nothing heavy is imported before a command needs it."""

import sys
from enum import StrEnum
from pathlib import Path
from typing import Annotated

from fogbench.bench.hidden import blaming_hidden, refuse_hidden_libraries

refuse_hidden_libraries()
with blaming_hidden():
    import typer

    from fogbench.worlds.mistake import encodable

app = typer.Typer(
    name="fogbench",
    help="Plan in the fog: learned and classical planners, one partial view, one scoreboard.\n\n"
    "Start with `fogbench run`: it plays every scenario, prints the tables and leaves them with the plots in results/. "
    "Stop it whenever you like; run the same command again to resume.",
    no_args_is_help=True,
    rich_markup_mode="markdown",
    add_completion=False,
)

DONE, CRASHED, STOPPED = 0, 1, 130
"""Exit codes: done; finished, but an agent crashed or hung; stopped by Ctrl-C. `terminal` has those of mistakes."""


class Device(StrEnum):
    """Where a network runs."""

    cpu = "cpu"
    cuda = "cuda"


Paths = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="[SCENARIO]...",
        help="Scenario files, folders of them, or names of shipped ones (`grid`). Default: all that are shipped.",
        show_default=False,
    ),
]
Results = Annotated[Path, typer.Option(help="Folder of the results of all scenarios.")]


def _say_version(asked: bool) -> None:
    if asked:
        from importlib.metadata import PackageNotFoundError, version

        try:
            typer.echo(f"fogbench {version('fogbench')}")
        except PackageNotFoundError:
            typer.echo("fogbench, from a checkout that is not installed")
        raise typer.Exit


@app.callback()
def every(
    *,
    _version: Annotated[
        bool, typer.Option("--version", callback=_say_version, is_eager=True, help="Say the version.")
    ] = False,
) -> None:
    """Options of the command itself."""


@app.command()
def run(
    scenarios: Paths = None,
    episodes: Annotated[
        int | None,
        typer.Option(
            min=1,
            max=1_000_000,
            help="Episodes per variant and agent, instead of what the files say.",
            show_default=False,
        ),
    ] = None,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Worker processes. Default: one for each CPU.", show_default=False)
    ] = None,
    results: Results = Path("results"),
) -> None:
    """Play the episodes that are not recorded yet, then print the tables and write them with the plots.

    Exit code 0: done. 1: finished, but an agent crashed or hung. 2: the command or a file was wrong.
    """
    try:
        from fogbench.bench.session import run_all

        crashed = run_all(_scenarios(scenarios), episodes, workers, results)
    except KeyboardInterrupt:
        typer.echo("Stopped. What was played is recorded; run the same command again to resume.", err=True)
        raise typer.Exit(STOPPED) from None
    raise typer.Exit(CRASHED if crashed else DONE)


@app.command()
def check(scenarios: Paths = None) -> None:
    """Read scenario files and their maps, report every mistake with its place, and say what a run would play."""
    from fogbench.bench.check import check_all

    check_all(_scenarios(scenarios))


@app.command("list")
def list_(
    name: Annotated[
        str | None,
        typer.Argument(
            help="Show the settings of a map family, an agent, a way to learn, a block (`sensor`, `rules`, `tasks`, "
            "`budget`), a kind of file (`scenario`, `recipe`), or a class (`./mine.py:Mine`).",
            show_default=False,
        ),
    ] = None,
) -> None:
    """List the scenarios, map families, agents, ways to learn, recipes and checkpoints; with NAME, its settings."""
    if name is None:
        from fogbench.bench.listing import show

        show()
    else:
        from fogbench.bench.reference import show_settings

        show_settings(name)


@app.command()
def schema() -> None:
    """Print the JSON Schema of scenario files, for completion and checks in editors."""
    import json

    from fogbench.bench.reading.schema import schema as scenario_schema

    typer.echo(json.dumps(scenario_schema(), indent=2))


@app.command()
def report(
    scenarios: Paths = None,
    against: Annotated[
        str | None,
        typer.Option(help="Label of an agent: paired tests against it; writes only `against-LABEL.md`."),
    ] = None,
    results: Results = Path("results"),
) -> None:
    """Print the tables of recorded episodes and write them with the plots; play nothing."""
    from fogbench.bench.session import compare_all, report_all

    if against is None:
        report_all(_scenarios(scenarios), results)
    else:
        compare_all(_scenarios(scenarios), against, results)


@app.command()
def replay(
    scenario: Annotated[str, typer.Argument(help="A scenario file, or the name of a shipped scenario.")],
    agent: Annotated[str, typer.Option(help="Label of the agent.")],
    variant: Annotated[str | None, typer.Option(help="Default: the first.", show_default=False)] = None,
    episode: Annotated[int, typer.Option(min=0, max=999_999, help="Number of the episode.")] = 0,
    out: Annotated[Path, typer.Option(help="`.png` draws a strip of moments, `.gif` every step.")] = Path("replay.png"),
    results: Results = Path("results"),
) -> None:
    """Play a recorded episode again, verify that it ends as recorded, and draw it.

    A picture shows the true map, what the agent had seen by then, its current view, and its path.
    """
    from fogbench.bench.playback import replay_recorded
    from fogbench.bench.several import read_all

    (chosen,) = read_all(_scenarios([scenario])[:1], sys.maxsize)
    typer.echo(replay_recorded(chosen, variant, agent, episode, results / chosen.name, out))


@app.command()
def look(
    scenario: Annotated[str, typer.Argument(help="A scenario file, or the name of a shipped scenario.")],
    agent: Annotated[str, typer.Option(help="Label of a network.")],
    variant: Annotated[str | None, typer.Option(help="Default: the first.", show_default=False)] = None,
    episode: Annotated[int, typer.Option(min=0, max=999_999, help="Number of the episode whose memory is drawn.")] = 0,
    results: Results = Path("results"),
) -> None:
    """Plot a network's features and memory from recorded episodes, beside the scenario's results.

    `tsne-VARIANT-AGENT.png`: t-SNE of its inputs, of the output of its planning module, and of its scores, coloured by
    the optimal move. Panel title: nearest-neighbour accuracy, over decisions of other episodes.

    `memory-VARIANT-AGENT.png`: its memory at each step of one episode; in a tunnel also the steps at which the agent
    first sees the end wall, turns back, and leaves.
    """
    from fogbench.bench.look import look_inside
    from fogbench.bench.several import read_all

    (chosen,) = read_all(_scenarios([scenario])[:1], sys.maxsize)
    typer.echo(look_inside(chosen, variant, agent, episode, results / chosen.name))


@app.command()
def train(
    recipe: Annotated[str, typer.Argument(help="A recipe file, or the name of a shipped one (`macn-grid`).")],
    device: Annotated[Device, typer.Option(help="Where the network runs.")] = Device.cpu,
    out: Annotated[
        Path | None,
        typer.Option(help="Folder for what is written. Default: results/training/NAME.", show_default=False),
    ] = None,
    batches: Annotated[
        int | None,
        typer.Option(min=1, max=10**9, help="Batches, instead of what the recipe says.", show_default=False),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(
            min=0, max=2**32 - 1, help="Instead of the recipe's; NAME becomes NAME-seedN.", show_default=False
        ),
    ] = None,
) -> None:
    """Train a network by a recipe. Stop it whenever you like; run the same command again to resume.

    A recipe names a network, the worlds where it learns, and how; `learned/recipes/` has those of the shipped
    checkpoints. Every few batches the network is tried on held-out maps: `log.jsonl` has a line for each trial,
    `learning.png` the curves. The best weights so far are `NAME.safetensors`, with a card beside them that says where
    they come from; a scenario plays them as `macn: {checkpoint: ./NAME.safetensors}`.
    """
    from fogbench.bench.training import train_recipe

    try:
        train_recipe(recipe, device.value, out, batches, seed)
    except KeyboardInterrupt:
        typer.echo("Stopped. Run the same command again to resume from the last saved state.", err=True)
        raise typer.Exit(STOPPED) from None


@app.command()
def doctor() -> None:
    """Compile all kernels; say what is installed, what is missing and how to get it, how fast this machine is.

    The last line is a verdict. Exit code 0: all that is installed works. 2: something does not.
    """
    from fogbench.bench.doctor import examine

    examine()


def _scenarios(names: list[str] | None) -> list[Path]:
    from fogbench.bench.shipped import find

    return find(names)


def main() -> None:
    """Run the command line; every mistake of a user ends in lines of text and exit code 2, never in a traceback."""
    from fogbench.bench.environment import set_environment
    from fogbench.bench.terminal import printing

    if sys.flags.optimize > 1:
        _document()
    with printing(), blaming_hidden():
        for line in set_environment():
            typer.echo(line, err=True)
        for argument in sys.argv[1:]:
            encodable(argument)
        app()


def _document() -> None:
    """Give the commands their texts where Python leaves docstrings out."""
    import ast

    tree = ast.parse(Path(__file__).read_text("utf-8"))
    texts = {node.name: ast.get_docstring(node) for node in tree.body if isinstance(node, ast.FunctionDef)}
    for command in app.registered_commands:
        command.help = texts[getattr(command.callback, "__name__", "")]
