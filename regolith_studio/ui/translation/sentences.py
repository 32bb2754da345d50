"""Sentences of the layers below, which know no languages: recognised by their words, told anew."""

import re
from functools import cache

from regolith_studio.ui.translation import mark, tr
from regolith_studio.ui.translation.health_sentences import HEALTH_SENTENCES

SENTENCES = (
    mark(
        "{surface} of the surface and {volume} of the volume are hidden from the star point and cannot be"
        " kept by a radius function."
    ),
    mark(
        "The expansion up to l = {degree} misses the radius by {error} in the root mean square, at most"
        " {most}; a higher l_max comes closer, and on flat or long grains so does an ellipsoid as reference."
    ),
    mark(
        "The expansion up to l = {degree} misses the radius by {error} in the root mean square; a higher"
        " l_max comes closer, and on flat or long grains so does an ellipsoid as reference."
    ),
    mark("The centre of mass lies outside the particle; the point with the least hidden volume is used."),
    mark("Sphericity {sphericity} needs at least {needed} facets; with {faces} the most is {most}."),
    mark("Sphericity {sphericity} needs more than 100,000 facets; with {faces} the most is {most}."),
    mark(
        "No polyhedron with {faces} facets was found that meets all descriptors: {name} is off by {error} %;"
        " more facets or a weight of 0 would free it."
    ),
    mark(
        "No polyhedron with {faces} facets was found that meets all descriptors: {name} is off by {error} %;"
        " a convex shape with the other descriptors has less surface, so a weight of 0 would free it."
    ),
    mark(
        "The result has {real} facets instead of {faces}: the particle is convex and has {facets} facets"
        " itself, and no other polyhedron was found that meets all descriptors."
    ),
    mark(
        "The result has {real} facets instead of {faces}: no place was found where the other half-spaces"
        " bound a facet and all descriptors are met."
    ),
    mark("The result has {real} facets instead of {faces}."),
    mark(
        "Not even {faces} facets bring all errors below {limit} %: the least is {error} %, with {count}"
        " facets."
    ),
    mark("1 grain from 1 connected body"),
    mark("1 grain from {bodies} connected bodies"),
    mark("{grains} grains from 1 connected body"),
    mark("{grains} grains from {bodies} connected bodies"),
    mark("{counts} at grey level {level}; {small} too small."),
    mark("1 particle; left out: {border} at the border, {small} too small."),
    mark("{count} particles; left out: {border} at the border, {small} too small."),
    mark("Looking at {name}"),
    mark("Reading {name}"),
    mark("The file is named {suffix} but is {format}."),
    mark("The file holds {count} volumes; {name} was read."),
    mark("The file holds {count} series of images; the largest was read."),
    mark("The file calls its {count} images channels; they were interpreted as slices."),
    mark("The file states the width of a pixel only; the slices were assumed to be the same distance apart."),
    mark("The file states voxel edges in different units; they were ignored."),
    mark("The file states a voxel of {size}, which is implausible; give the size of a voxel."),
    mark("{name} only"),
    mark("{name} × {factor}"),
    mark("{count} facets"),
    mark("Overlap + {symbols}"),
    mark("at least {limit}"),
    mark("at most {limit}"),
    mark(
        "Synthesised by Regolith Studio from the angular power spectrum and size spread of {count} particles"
        " of the published micro-CT set {name}, rounded to two digits; the length unit is taken as"
        " micrometres and no measured particle is contained."
    ),
    mark("Statistics of {count} particles of {name}, made by Regolith Studio."),
    mark("noise of sampling, split {split}"),
    mark("split {split} of {total}"),
    mark("{name}, split {split}, fit"),
    mark("{name}, split {split}, draw {draw}"),
    mark(
        "{count} measured particles at l_max = {degree}, {left} left out; fitted to one half, judged on the"
        " other; {splits} {split}, {draws} draws once from each fit, seed {seed}."
    ),
    mark(
        "{count} measured particles at l_max = {degree}, {left} left out; fitted to one half, judged on the"
        " other; {splits} {split}, {draws} draws {repeats} times from each fit, seed {seed}."
    ),
    *HEALTH_SENTENCES,
)
"""Fits, coarsenings, scans and files say these; what is in braces stands there filled in."""


def retold(sentence: str) -> str:
    """A sentence in the language of the window, with the numbers that it has; itself if it is not known."""
    if (known := tr(sentence)) != sentence:
        return known
    parts = _AFTER_A_SENTENCE.split(sentence)
    told = [retold(part) for part in parts] if len(parts) > 1 else parts
    if all(new != old for new, old in zip(told, parts, strict=True)):
        return " ".join(told)
    for template, form in _forms():
        if match := form.fullmatch(sentence):
            return tr(template, **{name: _word(value) for name, value in match.groupdict().items()})
    return sentence


def _word(value: str) -> str:
    """A name or a sentence inside a sentence; numbers stay what they are, sums are told term by term."""
    if PLUS in value:
        return PLUS.join(map(_word, value.split(PLUS)))
    if not value[:1].isalpha():
        return retold(value) if " " in value else value
    if (word := tr(value)) != value:
        return word
    known = tr(value[:1].upper() + value[1:])
    return known if known.lower() != value else value


_AFTER_A_SENTENCE = re.compile(r"(?<=\.) (?=[A-Z])")
PLUS = " + "
PARTS = (mark("size"), mark("box"), mark("sphericity"))
"""Terms of a loss as the study of the trade-off names them."""
TARGETS = (
    *(mark("yes"), mark("no"), mark("number"), mark("volume"), mark("split"), mark("splits")),
    mark("aspect ratio, times nearer than the paper's model"),
    mark("r_eq, A, AR, S: the worst, over the 95th percentile of noise"),
    mark("V/CH: Kolmogorov-Smirnov distance in floors"),
    mark("pairs of r_eq, A, AR: the largest energy distance [%]"),
    mark("draws thrown away [%]"),
    mark("median novelty"),
    *(mark("measured particles"), mark("figures")),
)
"""Words of the judgement of models."""


@cache
def _forms() -> tuple[tuple[str, re.Pattern[str]], ...]:
    found = []
    for template in SENTENCES:
        parts = re.split(r"\{(\w+)\}", template)
        form = "".join(f"(?P<{part}>.+?)" if at % 2 else re.escape(part) for at, part in enumerate(parts))
        found.append((template, re.compile(form)))
    return tuple(found)
