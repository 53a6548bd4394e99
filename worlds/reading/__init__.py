"""YAML read into settings, with every mistake at its place."""
