"""What the fuzzers share: damage to a file, a reader under watch, and the hunt that brings both together.

`tox` hunts for some seconds, always the same way; `tox -e fuzz -- 60` for as many minutes, each time another way.
"""

import io
import json
import re
import resource
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from pathlib import Path
from random import Random, SystemRandom
from time import monotonic
from typing import Any

import psutil
import pytest
import yaml
from hypothesis import HealthCheck, given, seed, settings
from hypothesis import strategies as st

from fogbench.bench.command import main

SECONDS, BYTES = 10.0, 2 * 2**30
"""What one file may take. The slowest, a task that no map of 4096x4096 cells has, takes four seconds."""

EXAMPLES = 150
"""Files of each format in `tox`."""

ODD = [
    *(
        b"",
        b"0",
        b"-1",
        b"1.5",
        b"1e400",
        b"1e-400",
        b"nan",
        b".inf",
        b"-.inf",
        b"9" * 20,
        b"9" * 5000,
        b"0x10",
        b"010",
    ),
    *(b"yes", b"~", b"null", b"true", b"1:30", b"2026-13-45", b"1_000", b"1e3", b"+3", b"\xd9\xa3", b"-0"),
    *(b"[", b"]", b"{", b"}", b"'", b'"', b"|", b"%", b"@", b"`", b"- ", b": ", b"#", b"<<", b"---\n", b"&a", b"*a"),
    *(b"!!bool x", b"!!int ''", b"!!float ''", b"!!timestamp x", b"!!binary x", b"!!python/name:os.system", b"!x y"),
    *(b'"\\0"', b'"\\ud800"', b"\x00", b"\xff\xfe", b"\xef\xbb\xbf", b"\xe2\x80\xa8", b"\xc2\x85", b"\r", b"\n", b"\t"),
    *(b"/dev/zero", b"/", b".", b"..", b"../x", b"${HOME}", b"${NO_SUCH}", b"$x$", b"[/red]", b"x" * 300),
    *(b"[" * 3000, b"{a: " * 2000, b'"\\e[31m"', b"astar", b"macn", b"none", b"all", b"file.py:X", b"no.such:X"),
]
"""Words that upset a reader."""

STRANGE = [
    *(None, True, False, 0, -1, 1.5, 1e308, -1e-308, 2**31, 2**63, 2**64, -(2**63), float("nan"), float("inf")),
    *("", " ", "x" * 300, "\x00", "1", "nan", "ä\u2028", "\U0001f600", "../x", "${NO_SUCH}", "/dev/zero", "a.b"),
    *([], {}, [[]], [0, 0, 0], {"": 0}, {"x": {}}, [None], [[[[[[]]]]]]),
]
"""Values that upset what reads a tree."""

WORD = re.compile(rb"[^\s,:{}\[\]]+")

FOREIGN = re.compile(r"\b\w*(Error|Exception|Warning|Interrupt)\b(?=[:(])|Traceback|<class |object at 0x")
"""Words of Python, which no line for a user has."""

ORDERS = re.compile(r"[\x00-\x1f\x7f-\x9f\u2028-\u202e]")
"""Letters that a terminal obeys."""

NUMBER = re.compile(rb"(?<![\w.])-?\d+(\.\d+)?")

NUMBERS = [
    *range(-2, 4),
    7,
    64,
    255,
    256,
    999,
    65_536,
    10**6,
    10**9,
    2**31,
    2**32 - 1,
    2**63 - 1,
    2**63,
    10**20,
    10**400,
]
"""Numbers that upset what counts or makes room."""

COUNTS = pytest.StashKey[dict[str, int]]()


def pytest_addoption(parser: pytest.Parser) -> None:
    """How long to hunt, and from where to start."""
    parser.addoption("--fuzz-minutes", type=float, default=0, help="Hunt so long, all formats together, at random.")
    parser.addoption("--fuzz-seed", type=int, default=None, help="The seed that a hunt has told, to repeat it.")


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    """Say how many files were tried."""
    for name, count in config.stash.get(COUNTS, {}).items():
        terminalreporter.write_line(f"{name}: {count:,} damaged files were read.")


def _span(luck: Random, text: bytes, most: int = 64) -> tuple[int, int]:
    """A piece of a text, sooner from its head."""
    start = int(len(text) * luck.random() ** 2)
    return start, min(len(text), start + luck.randrange(1, most))


def _cut(luck: Random, text: bytes) -> bytes:
    start, end = _span(luck, text)
    return text[:start] + text[end:]


def _end(luck: Random, text: bytes) -> bytes:
    return text[: _span(luck, text)[0]]


def _repeat(luck: Random, text: bytes) -> bytes:
    start, end = _span(luck, text)
    return text[:start] + text[start:end] * luck.choice([2, 3, 300]) + text[end:]


def _exchange(luck: Random, text: bytes) -> bytes:
    lines = text.splitlines(keepends=True) or [b""]
    one, other = luck.randrange(len(lines)), luck.randrange(len(lines))
    lines[one], lines[other] = lines[other], lines[one]
    return b"".join(lines)


def _drop(luck: Random, text: bytes) -> bytes:
    lines = text.splitlines(keepends=True) or [b""]
    del lines[luck.randrange(len(lines))]
    return b"".join(lines)


def _flip(luck: Random, text: bytes) -> bytes:
    place, _ = _span(luck, text + b"\0")
    bit = 1 << luck.randrange(8)
    return text[:place] + bytes(byte ^ bit for byte in text[place : place + 1]) + text[place + 1 :]


def _replace(luck: Random, text: bytes) -> bytes:
    words = [found.span() for found in WORD.finditer(text)] or [(0, 0)]
    start, end = luck.choice(words)
    return text[:start] + luck.choice(ODD) + text[end:]


def _count(luck: Random, text: bytes) -> bytes:
    numbers = [found.span() for found in NUMBER.finditer(text)] or [(0, 0)]
    start, end = luck.choice(numbers)
    return text[:start] + f"{luck.choice(NUMBERS)}{luck.choice(['', '', '', '.5', 'e300'])}".encode() + text[end:]


def _insert(luck: Random, text: bytes) -> bytes:
    start, _ = _span(luck, text)
    return text[:start] + luck.choice(ODD) + text[start:]


def _tree(luck: Random, text: bytes) -> bytes:
    """A file of YAML or JSON of which one value, somewhere, is strange, missing, renamed, wrapped or another's."""
    try:
        page = yaml.safe_load(text)
    except (yaml.YAMLError, ValueError, KeyError, IndexError, AttributeError, RecursionError):
        return text
    spots = list(_spots(page))
    if not spots:
        return text
    (holder, key), (giver, other) = luck.choice(spots), luck.choice(spots)
    way = luck.randrange(5)
    if way == 0:
        holder[key] = luck.choice(STRANGE)
    elif way == 1:
        del holder[key]
    elif way == 2 and isinstance(holder, dict):
        holder[luck.choice([f"{key}x", "", 1, None, "all"])] = holder.pop(key)
    elif way == 3:
        holder[key] = json.loads(json.dumps(giver[other], default=str))
    else:
        holder[key] = [holder[key]] * luck.choice([1, 2, 50])
    return json.dumps(page, default=str).encode() if text[:1] == b"{" else yaml.safe_dump(page).encode()


def _spots(page: Any) -> Iterator[tuple[Any, Any]]:
    """Every holder and key of a tree."""
    keys: Any = page.keys() if isinstance(page, dict) else range(len(page)) if isinstance(page, list) else ()
    for key in list(keys):
        yield page, key
        yield from _spots(page[key])


WAYS = [_replace, _count, _insert, _cut, _end, _repeat, _exchange, _drop, _flip, _tree]


def damage(luck: Random, seeds: tuple[bytes, ...]) -> bytes:
    """One of some good files, damaged once to three times."""
    text = luck.choice(seeds)
    for _ in range(luck.randrange(1, 4)):
        text = luck.choice(WAYS)(luck, text)
    return text


class Late(BaseException):
    """A file takes too long; nobody catches this on the way."""


@contextmanager
def bounded(seconds: float = SECONDS) -> Iterator[None]:
    """Whatever runs in here may take so long, and so much memory."""

    def late(*_: Any) -> None:
        raise Late

    limits, before = resource.getrlimit(resource.RLIMIT_AS), signal.signal(signal.SIGALRM, late)
    resource.setrlimit(resource.RLIMIT_AS, (psutil.Process().memory_info().vms + BYTES, limits[1]))
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    except Late:
        raise AssertionError(f"got no answer after {seconds} s; expected one in no time") from None
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
        resource.setrlimit(resource.RLIMIT_AS, limits)


def told(words: list[str], seconds: float = SECONDS) -> tuple[int, list[str]]:
    """The exit code of a command that runs in this process, and the lines of its error output.

    Both streams are strict UTF-8 and escaped UTF-8, as those of a terminal. An error that is no exit goes through.
    """
    out = io.TextIOWrapper(io.BytesIO(), "utf-8")
    err = io.TextIOWrapper(io.BytesIO(), "utf-8", "backslashreplace")
    before, sys.argv, code = sys.argv, ["fogbench", *words], 0
    try:
        with redirect_stdout(out), redirect_stderr(err), bounded(seconds):
            main()
    except SystemExit as end:
        code = int(end.code or 0)
    finally:
        sys.argv = before
    err.flush()
    return code, err.buffer.getvalue().decode().splitlines()  # type: ignore[attr-defined]


def judge(code: int, lines: list[str], stem: str) -> None:
    """Hold an answer against the promise: a run, or exit code 2 and lines that begin with a place and name the file."""
    assert code in (0, 2), f"got exit code {code}; expected 0 or 2"
    assert bool(lines) == (code == 2), f"got exit code {code} with {len(lines)} lines: {lines}"
    for line in lines:
        assert stem in line, f"got a line without the file: {line}"
        assert re.match(r"[\w./-]+\.\w+(:\d+)*(: |  )\S", line), f"got a line without a place: {line}"
        assert not FOREIGN.search(line), f"got a word of Python in a line: {line}"
        assert len(line) < 1000, f"got a line of {len(line)} letters: {line[:200]}..."
        assert not ORDERS.search(line), f"got a line that a terminal would obey: {line!r}"


Attempt = Callable[[bytes], Any]


@pytest.fixture
def hunt(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    """Tries damaged files one after the other: the name of the format, its good files, and what takes one file.

    The first that fails is made as small as can be; it is told as `contents=...`, and the seed with it.
    """
    monkeypatch.chdir(tmp_path)
    config = request.config
    minutes, start = config.getoption("fuzz_minutes", 0), config.getoption("fuzz_seed", None)
    counts = config.stash.setdefault(COUNTS, {})

    def once(attempt: Attempt, seeds: tuple[bytes, ...], examples: int, number: int | None) -> None:
        files = st.randoms(use_true_random=False).map(lambda luck: damage(luck, seeds))
        own = settings(
            max_examples=examples,
            derandomize=number is None,
            deadline=None,
            database=None,
            report_multiple_bugs=False,
            suppress_health_check=list(HealthCheck),
        )
        test = own(given(contents=files)(attempt))
        (test if number is None else seed(number)(test))()

    def hunt(name: str, seeds: tuple[bytes, ...], attempt: Attempt, share: float = 1, examples: int = EXAMPLES) -> None:
        def counted(contents: bytes) -> None:
            counts[name] = counts.get(name, 0) + 1
            attempt(contents)

        end = monotonic() + 60 * minutes * share
        number = None if not minutes and start is None else start
        while True:
            if minutes and start is None:
                number = SystemRandom().randrange(2**32)
            try:
                once(counted, seeds, 500 if number is not None else examples, number)
            except BaseException as error:
                if number is not None:
                    error.add_note(f"To repeat it: tox -e fuzz -- 0 --fuzz-seed {number} -k {name}")
                raise
            if start is not None or monotonic() >= end:
                return

    return hunt


@pytest.fixture
def watched() -> Any:
    """`told`, `judge` and `damage`, for the tests."""
    return told, judge, damage
