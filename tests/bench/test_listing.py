"""The tables of what is at hand."""

import subprocess
import sys


def test_listing_loads_neither_numbers_nor_settings() -> None:
    """It prints what is written, so it comes at once."""
    heavy = {"numpy", "pydantic", "pandas", "numba"}
    code = f"from fogbench.bench.listing import show; show(); import sys; print(sorted({heavy} & set(sys.modules)))"
    text = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert text.endswith("\n[]\n")
