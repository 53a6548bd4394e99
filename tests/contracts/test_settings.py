"""The contract of every settings class of the tables."""

from typing import Any

import pytest
from pydantic import ValidationError


def test_settings_are_frozen(settings: Any) -> None:
    """No field can be changed, and none added."""
    for name in [*type(settings).model_fields, "anything"]:
        with pytest.raises(ValidationError, match="frozen"):
            setattr(settings, name, 1)


def test_settings_are_closed(settings: Any) -> None:
    """A field that a class does not know is refused."""
    with pytest.raises(ValidationError, match="extra_forbidden"):
        type(settings).model_validate({**settings.model_dump(), "anything": 1})


def test_settings_survive_json(settings: Any) -> None:
    """What is written down as JSON is read back equal, and equal settings have equal hashes."""
    again = type(settings).model_validate_json(settings.model_dump_json())
    assert again == settings
    assert hash(again) == hash(settings)


def test_settings_say_what_they_are(settings: Any) -> None:
    """The class and each of its fields have a sentence of their own."""
    sentences = [type(settings).__doc__, *(field.description for field in type(settings).model_fields.values())]
    assert all(text and text.strip().endswith(".") for text in sentences)
