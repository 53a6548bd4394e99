"""From the text of a scenario file to settings, with every mistake at its place."""
