"""Everything in a scenario that is neither maps nor agents, for worlds of kind `grid`."""

from fogbench.worlds.conditions import BudgetSettings, Tasks
from fogbench.worlds.grid.rules import GridRules, SquareView
from fogbench.worlds.settings import Settings


class GridConditions(Settings):
    """Everything in a scenario that is neither maps nor agents, for worlds of kind `grid`."""

    sensor: SquareView = SquareView()
    rules: GridRules = GridRules()
    tasks: Tasks = Tasks()
    budget: BudgetSettings
