"""Families of graphs: drawn afresh, one for all episodes, or read from a file."""
