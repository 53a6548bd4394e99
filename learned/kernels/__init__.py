"""Compiled loops for networks: lanes of numbers, threads without Python, linear layers."""
