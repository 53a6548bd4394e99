"""A robot that plans on the current scan alone."""

from fogbench.planners.robot.agent import plan, points
from fogbench.planners.robot.pilot import Pilot
from fogbench.worlds.robot.known import RobotMap
from fogbench.worlds.types import Observation, Task, Waypoint


class MemorylessRobot:
    """One episode of a robot that forgets all walls; it knows how fast it drives, and whether it has stayed."""

    def __init__(self, task: Task) -> None:
        """Plan towards the task's goal."""
        self.task = task
        self.pilot = Pilot(task.sensor)
        self.expanded = 0

    def act(self, observation: Observation) -> Waypoint | None:
        """A waypoint on the cheapest path on the current scan; gives up where that leaves none."""
        known = RobotMap(self.task)
        known.update(observation)
        path, expanded = plan(known, observation.place, self.task.goal, optimist=True)
        self.expanded += expanded
        if not len(path):
            return None
        return self.pilot.waypoint(known.cells, observation.place, points(self.task, path))

    def memory_bytes(self) -> int:
        """No array is carried from one decision to the next."""
        return 0

    def search_nodes(self) -> int:
        """Cells expanded so far."""
        return self.expanded
