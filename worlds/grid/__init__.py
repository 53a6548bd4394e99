"""The grid world: four moves on a map of cells, seen through a square sensor."""
