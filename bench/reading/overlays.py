"""The variants of a file: each laid over the rest, and what is wrong with all of them told once."""

from collections.abc import Sequence
from dataclasses import replace

from fogbench.bench.reading.page import VARIED
from fogbench.bench.reading.positions import Fault, Value, merge
from fogbench.worlds.mistake import near, one_of

ALONE = "all"
"""The name of the one variant of a file without variants."""


def pages(page: Value, faults: list[Fault], varied: Sequence[str] = VARIED) -> dict[str, Value]:
    """The whole page of each variant, by its name; only the keys in `varied` may differ."""
    variants = page.fields().get("variants")
    overlays = variants.fields() if variants else {}
    for overlay in overlays.values():
        unknown = overlay.fields().keys() - set(varied)
        faults.extend(overlay.wrong_key(key, one_of(varied), near(key, varied)) for key in unknown)
    return {name: _lay(page, overlay, varied) for name, overlay in overlays.items()} or {ALONE: page}


def _lay(page: Value, overlay: Value, varied: Sequence[str]) -> Value:
    """The page of one variant: another map family replaces the one of the page, with all its settings."""
    fields = {key: value for key, value in overlay.fields().items() if key in varied}
    here, there = (
        mapping["maps"].fields().keys() if "maps" in mapping else set() for mapping in (page.fields(), fields)
    )
    if there and not here & there:
        page = replace(page, content={key: value for key, value in page.fields().items() if key != "maps"})
    return merge(page, replace(overlay, content=fields))


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
