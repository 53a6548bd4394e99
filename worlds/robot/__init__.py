"""The robot world: a body with two driven wheels and a lidar, between walls made of any map of cells."""
