"""What `fogbench train` does: it reads a recipe, trains, and shows how far it is and what is reached."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from fogbench.bench.playing.provenance import circumstances
from fogbench.bench.reading.recipe import read_recipe
from fogbench.bench.reading.scenario import text_of
from fogbench.bench.shipped import find_recipe
from fogbench.learned.training.recipe import Recipe
from fogbench.worlds.files import alone
from fogbench.worlds.mistake import Mistake

if TYPE_CHECKING:
    from fogbench.learned.training.course import Course, Trial

TRAININGS = Path("results/training")
"""Where trainings are kept."""


def train_recipe(said: str, device: str, out: Path | None, batches: int | None, seed: int | None) -> None:
    """Train by a recipe, or go on where a training was stopped.

    Args:
        said: the name of a shipped recipe, or a file.
        device: `cpu` or `cuda`.
        out: the folder for all that is written; None: one with the recipe's name.
        batches: in place of what the recipe says.
        seed: in place of what the recipe says; the name tells it.

    Raises:
        ScenarioError: all the mistakes of the file.
        Mistake: there is no such recipe or device, or the folder holds another training or is trained in right now.
    """
    path = find_recipe(said)
    recipe = _changed(read_recipe(text_of(path), path), device, batches, seed)
    from fogbench.learned.training.course import Course  # noqa: PLC0415  it loads PyTorch, which a broken recipe need not

    folder, console = out or TRAININGS / recipe.name, Console()
    with alone(folder, "training"):
        _train(Course(recipe, folder, circumstances()), console)


def _train(course: "Course", console: Console) -> None:
    """Train to the end, with a bar, and a line for each trial."""
    recipe = course.recipe
    columns = (
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
        TextColumn("{task.fields[loss]}"),
    )
    with Progress(TextColumn("{task.description}", markup=False), *columns, console=console) as bars:
        total, done = recipe.learning.batches, course.student.batches
        if done:
            _say(f"Resumes from batch {done}." if done < total else f"All {total} batches were done before.", console)
        bar = bars.add_task(recipe.name, total=total, completed=done, loss="")
        for news in course.go_on():
            bars.update(bar, completed=news.batches, loss=f"loss {news.loss:.3f}")
            if news.trial:
                _say(_told(news.trial), console)
                _draw(course, console)
    _say(f"The best weights ({course.best[0]:.1f} % success over all variants) are in {course.weights}", console)


def _draw(course: "Course", console: Console) -> None:
    """Draw the curves; where they cannot be drawn, the training goes on."""
    try:
        from fogbench.bench.reporting.learning import write_curves  # noqa: PLC0415  it may not load

        write_curves(course.trials, course.folder)
    except Mistake as mistake:
        _say(str(mistake), console)


def _changed(recipe: Recipe, device: str, batches: int | None, seed: int | None) -> Recipe:
    """A recipe with what the command line says in its place."""
    learning: Any = recipe.learning
    if batches is not None:
        learning = learning.model_copy(update={"batches": batches})
    if seed is not None:
        recipe = replace(recipe, name=f"{recipe.name}-seed{seed}", seed=seed)
    network = recipe.network.model_copy(update={"device": device, "seed": recipe.seed})
    if device == "cuda":
        import torch  # noqa: PLC0415  only now is it asked

        if not torch.cuda.is_available():
            raise Mistake("--device: got cuda, but PyTorch finds no CUDA device here; expected cpu.")
    return replace(recipe, network=network, learning=learning)


def _told(trial: "Trial") -> str:
    """A trial in one line."""
    reached = ", ".join(
        f"{name}: {score['success']:.1f} % success, test error {score['test_error']:.3f}"
        for name, score in trial["variants"].items()
    )
    return f"batch {trial['batch']}: loss {trial['loss']:.3f}; {reached}"


def _say(text: str, console: Console) -> None:
    console.print(text, highlight=False, markup=False, soft_wrap=True)
