"""Planners of the robot: searches on the room around cells, and the one way in which their paths are driven."""
