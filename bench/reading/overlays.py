"""The variants of a file: each laid over the rest, and what is wrong with all of them told once."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

from fogbench.bench.reading.page import NAME, is_name
from fogbench.worlds.mistake import near, one_of
from fogbench.worlds.reading.positions import Fault, Value, merge

ALONE = "all"
"""The name of the one variant of a file without variants."""


def pages(
    page: Value, faults: list[Fault], varied: Sequence[str], blocks_of: Callable[[Value], Sequence[str] | None]
) -> dict[str, Value]:
    """The whole page of each variant, by its name.

    Args:
        page: of the file.
        faults: what is wrong with the variants is added to them.
        varied: keys that may differ, beside the blocks of the kinds of world in the file.
        blocks_of: the blocks that the kind of a whole page reads; None where nobody knows them.
    """
    variants = page.fields().get("variants")
    overlays = variants.fields() if variants else {}
    own = {name: blocks_of(_lay(page, overlay)) for name, overlay in overlays.items()}
    blocks = list(dict.fromkeys(block for each in own.values() for block in each or ()))
    place = varied.index("kind") + 1
    known = [*varied[:place], *blocks, *varied[place:]]
    laid = {}
    for name, overlay in overlays.items():
        read = own[name]
        if variants and not is_name(name):
            faults.append(variants.wrong_key(name, NAME))
        unknown = set() if read is None else overlay.fields().keys() - set(known)
        faults.extend(overlay.wrong_key(key, one_of(known), near(key, known)) for key in unknown)
        fitting = page if read is None else _without(page, set(blocks) - set(read))
        laid[name] = _lay(fitting, _without(overlay, unknown))
    return laid or {ALONE: page}


def _without(mapping: Value, keys: Iterable[str]) -> Value:
    """A mapping without some keys: blocks that are for other kinds, or keys that are unknown, and told."""
    left_out = set(keys)
    return replace(mapping, content={key: value for key, value in mapping.fields().items() if key not in left_out})


def _lay(page: Value, overlay: Value) -> Value:
    """One variant laid over the page: another map family replaces the one of the page, with all its settings."""
    here, there = (
        mapping["maps"].fields().keys() if "maps" in mapping else set() for mapping in (page.fields(), overlay.fields())
    )
    if there and not here & there:
        page = _without(page, {"maps"})
    return merge(page, replace(overlay, content=overlay.fields()))


def settle(rows: list[list[Fault]]) -> list[Fault]:
    """The faults of all variants, each once; what every variant lacks is a fault of what they are laid over."""
    common = set.intersection(*({fault.base or fault for fault in row} for row in rows))
    return [fault.base if fault.base and fault.base in common else fault for row in rows for fault in row]


def unknown_variants(page: Value, names: list[str]) -> list[Fault]:
    """Published numbers of variants that are not in the file."""
    published = page.fields().get("published")
    metrics = published.fields().values() if published else ()
    agents = [agent for metric in metrics for agent in metric.fields().values()]
    return [
        agent.wrong_key(name, one_of(names), near(name, names))
        for agent in agents
        for name in agent.fields()
        if name not in names
    ]
