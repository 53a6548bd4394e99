"""The environment of a command: what would change what kernels compute is put right, and told.

Numba takes options of its compiler from variables, and from a file `.numba_config.yaml` where the user stands. Some
give other numbers: without compilation whole numbers do not wrap around, and sums of products round elsewhere.
"""

import os

COMPILED = {
    "NUMBA_DISABLE_JIT": "0",
    "NUMBA_OPT": "3",
    "NUMBA_LOOP_VECTORIZE": "1",
    "NUMBA_SLP_VECTORIZE": "0",
    "NUMBA_DISABLE_INTEL_SVML": "0",
}
"""How kernels are compiled for everyone. A variable is stronger than the file, so all of them are set."""

LEFT = ("NUMBA_BOUNDSCHECK", "NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES", "NUMBA_ENABLE_AVX")
"""What is left to the kernel or to the machine where nothing is said."""


def set_environment() -> list[str]:
    """Set the variables of this process and its workers, before Numba is imported.

    Returns:
        A line for each variable that said something else.
    """
    odd = [name for name, value in COMPILED.items() if os.environ.get(name, value) != value]
    odd += [name for name in LEFT if os.environ.pop(name, None) is not None]
    os.environ.update(COMPILED)
    return [f"{name} is ignored: episodes can be compared only if all kernels are compiled alike." for name in odd]
