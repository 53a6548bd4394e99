"""Weights on the disk: what was written is read back, and whatever is wrong with a file is one sentence."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from safetensors.torch import save_file

from fogbench.learned import checkpoint
from fogbench.learned.agent import weighted
from fogbench.learned.checkpoint import forms, located, place_of, read_card, read_weights
from fogbench.learned.vin import Vin
from fogbench.worlds.files import sha256
from fogbench.worlds.mistake import Mistake

VIN = Vin(checkpoint="none", seed=3)

FORMS = forms(VIN.shapes())


@pytest.fixture
def place(save: Callable[..., str]) -> Path:
    """A checkpoint of a small network."""
    return Path(save(VIN, "small"))


def change(card: Path, **fields: Any) -> None:
    """Overwrite fields of a card."""
    card.write_text(json.dumps({**json.loads(card.read_text()), **fields}))


def wrong(place: Path) -> str:
    """What is wrong with a checkpoint."""
    with pytest.raises(Mistake) as caught:
        read_weights(place, read_card(place).sha256, FORMS)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_what_was_written_is_read(place: Path) -> None:
    """All tensors, bit for bit, and the card."""
    card = read_card(place)
    weights = read_weights(place, card.sha256, FORMS)
    for name, tensor in weighted(VIN).state_dict().items():
        assert np.array_equal(weights[name], tensor)
    assert (card.network, card.training) == ("Vin", {"batches": 3})
    assert card.settings["iterations"] == VIN.iterations
    assert sorted(file.name for file in place.parent.iterdir()) == ["small.json", "small.safetensors"]


@pytest.mark.parametrize("cut", [1, 100, 10_000])
def test_truncated(place: Path, cut: int) -> None:
    """A file that lost its end."""
    place.write_bytes(place.read_bytes()[:-cut])
    assert (
        wrong(place) == "a checkpoint that is whole (small.safetensors is not the file that its card was written for)"
    )


def test_corrupted(place: Path) -> None:
    """A file with one changed bit, which its format would not notice."""
    contents = bytearray(place.read_bytes())
    contents[-1] ^= 1
    place.write_bytes(contents)
    assert (
        wrong(place) == "a checkpoint that is whole (small.safetensors is not the file that its card was written for)"
    )


def test_not_weights(place: Path) -> None:
    """A file of another format whose card agrees with it."""
    place.write_bytes(b'\x08\0\0\0\0\0\0\0{"a": 1}')
    change(place.with_suffix(".json"), sha256=sha256(place.read_bytes()))
    assert wrong(place).startswith("a file of weights (small.safetensors: ")


def test_other_shapes(place: Path) -> None:
    """Weights of other shapes than the card's settings make."""
    weights = dict(weighted(VIN).state_dict(), **{"output.weight": torch.zeros(4, 5)})
    save_file(weights, place)
    change(place.with_suffix(".json"), sha256=sha256(place.read_bytes()))
    assert wrong(place) == (
        "a checkpoint that fits its card "
        "(small.safetensors: output.weight is float32 [4, 5] there, float32 [4, 4] here)"
    )


def test_other_numbers(place: Path) -> None:
    """Weights of another type, and some that are not numbers."""
    where = "(small.safetensors: output.weight"
    for tensor, sentence in (
        (torch.zeros(4, 4).long(), f"that fits its card {where} is int64 [4, 4] there, float32 [4, 4] here)"),
        (torch.full((4, 4), torch.nan), f"of numbers {where} has some that are none)"),
    ):
        save_file(dict(weighted(VIN).state_dict(), **{"output.weight": tensor}), place)
        change(place.with_suffix(".json"), sha256=sha256(place.read_bytes()))
        assert wrong(place) == f"a checkpoint {sentence}"


def test_missing_and_foreign_weights(place: Path) -> None:
    """A tensor too few, and one too many."""
    weights = weighted(VIN).state_dict()
    weights["output.bias"] = torch.zeros(4)
    save_file(weights, place)
    change(place.with_suffix(".json"), sha256=sha256(place.read_bytes()))
    assert wrong(place).endswith("(small.safetensors: output.bias is float32 [4] there, missing here)")
    del weights["output.bias"], weights["output.weight"]
    save_file(weights, place)
    change(place.with_suffix(".json"), sha256=sha256(place.read_bytes()))
    assert wrong(place).endswith("(small.safetensors: output.weight is missing there, float32 [4, 4] here)")


def test_cards_that_cannot_be_read(place: Path) -> None:
    """No card, no JSON, and a card that lacks something."""
    card = place.with_suffix(".json")
    card.write_text("{")
    assert wrong(place).startswith("a checkpoint whose card can be read (small.json: Invalid JSON: ")
    card.write_text("{}")
    assert wrong(place) == "a checkpoint whose card can be read (small.json: network: Field required)"
    card.write_bytes("{é}".encode("latin-1"))
    assert wrong(place).startswith("a checkpoint whose card can be read (small.json: 'utf-8' codec")
    card.unlink()
    assert wrong(place) == "a checkpoint with its card (there is no small.json beside small.safetensors)"


def test_files_that_are_not_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file or a shipped checkpoint that is named must exist; the nearest of the shipped ones is told."""
    with pytest.raises(Mistake) as caught:
        located("no.safetensors", tmp_path.joinpath)
    assert str(caught.value) == f"an existing file (looked for {tmp_path}/no.safetensors)"
    monkeypatch.setattr(checkpoint, "SHIPPED", tmp_path)
    for shipped, near in ((), ""), (("macn-grid",), "macn-grid"):
        for name in shipped:
            (tmp_path / f"{name}.safetensors").touch()
        with pytest.raises(Mistake) as caught:
            located("macn-gird", tmp_path.joinpath)
        assert str(caught.value) == f"a file that ends in .safetensors, or one of {', '.join(['none', *shipped])}"
        assert caught.value.near == near
    assert located("macn-grid", tmp_path.joinpath) == "macn-grid"
    assert place_of("macn-grid") == tmp_path / "macn-grid.safetensors"
