"""Families of maps, one file each."""
