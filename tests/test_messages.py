"""Texts that remember their template and their values."""

import json
import pickle

from regolith_studio.errors import InputError
from regolith_studio.messages import N_, Message, Number, count_message, from_json, join_messages, to_json

GRAINS = Message(N_("{grains} of {body}"), grains=3, body=Message(N_("one body")))


def test_that_a_message_is_its_english_text():
    assert GRAINS == "3 of one body"
    assert json.dumps(GRAINS) == '"3 of one body"'
    assert str(InputError(GRAINS)) == GRAINS
    assert InputError(GRAINS).args[0].template == "{grains} of {body}"


def test_that_a_message_survives_another_process_and_json():
    for copy in (pickle.loads(pickle.dumps(GRAINS)), from_json(json.loads(json.dumps(to_json(GRAINS))))):
        assert copy == GRAINS
        assert copy.template == GRAINS.template
        assert copy.values == GRAINS.values
        assert copy.values["body"].template == "one body"
    assert from_json(to_json("plain {text}")) == "plain {text}"


def test_that_one_thing_and_several_have_texts_of_their_own():
    assert count_message("1 face", "{count} faces", 1) == "1 face"
    assert count_message("1 face", "{count} faces", 1200) == "1,200 faces"


def test_that_texts_are_joined_with_their_values():
    both = join_messages([GRAINS, "plain {text}"])
    assert both == "3 of one body plain {text}"
    assert both.values["part_0"] is GRAINS


def test_that_a_number_stays_one_in_another_process_and_in_json():
    sentence = Message("{share} of the surface", share=Number(0.123456, ".3g", " %"))
    assert sentence == "0.123 % of the surface"
    for copy in (pickle.loads(pickle.dumps(sentence)), from_json(json.loads(json.dumps(to_json(sentence))))):
        assert isinstance(copy.values["share"], Number)
        assert copy.values["share"] == "0.123 %"
