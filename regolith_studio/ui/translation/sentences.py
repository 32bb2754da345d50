"""Sentences of the layers below, which know no languages: recognised by their words, told anew."""

import re
from functools import cache

from regolith_studio.messages import N_
from regolith_studio.ui.translation import tr
from regolith_studio.ui.translation.health_sentences import HEALTH_SENTENCES

SENTENCES = (
    N_(
        "{surface} of the surface and {volume} of the volume are hidden from the star point and cannot be"
        " kept by a radius function."
    ),
    N_(
        "The expansion up to l = {degree} misses the radius by {error} in the root mean square, at most"
        " {most}; a higher l_max comes closer, and on flat or long grains so does an ellipsoid as reference."
    ),
    N_(
        "The expansion up to l = {degree} misses the radius by {error} in the root mean square; a higher"
        " l_max comes closer, and on flat or long grains so does an ellipsoid as reference."
    ),
    N_("The centre of mass lies outside the particle; the point with the least hidden volume is used."),
    N_("Sphericity {sphericity} needs at least {needed} facets; with {faces} the most is {most}."),
    N_("Sphericity {sphericity} needs more than 100,000 facets; with {faces} the most is {most}."),
    N_(
        "No polyhedron with {faces} facets was found that meets all descriptors: {name} is off by {error} %;"
        " more facets or a weight of 0 would free it."
    ),
    N_(
        "No polyhedron with {faces} facets was found that meets all descriptors: {name} is off by {error} %;"
        " a convex shape with the other descriptors has less surface, so a weight of 0 would free it."
    ),
    N_(
        "The result has {real} facets instead of {faces}: the particle is convex and has {facets} facets"
        " itself, and no other polyhedron was found that meets all descriptors."
    ),
    N_(
        "The result has {real} facets instead of {faces}: no place was found where the other half-spaces"
        " bound a facet and all descriptors are met."
    ),
    N_("The result has {real} facets instead of {faces}."),
    N_(
        "Not even {faces} facets bring all errors below {limit} %: the least is {error} %, with {count}"
        " facets."
    ),
    N_("1 grain from 1 connected body"),
    N_("1 grain from {bodies} connected bodies"),
    N_("{grains} grains from 1 connected body"),
    N_("{grains} grains from {bodies} connected bodies"),
    N_("{counts} at grey level {level}; {small} too small."),
    N_("1 particle; left out: {border} at the border, {small} too small."),
    N_("{count} particles; left out: {border} at the border, {small} too small."),
    N_("Looking at {name}"),
    N_("Reading {name}"),
    N_("The file is named {suffix} but is {format}."),
    N_("The file holds {count} volumes; {name} was read."),
    N_("The file holds {count} series of images; the largest was read."),
    N_("The file calls its {count} images channels; they were interpreted as slices."),
    N_("The file states the width of a pixel only; the slices were assumed to be the same distance apart."),
    N_("The file states voxel edges in different units; they were ignored."),
    N_("The file states a voxel of {size}, which is implausible; give the size of a voxel."),
    N_("{name} only"),
    N_("{name} × {factor}"),
    N_("{count} facets"),
    N_("Overlap + {symbols}"),
    N_("at least {limit}"),
    N_("at most {limit}"),
    N_(
        "Synthesised by Regolith Studio from the angular power spectrum and size spread of {count} particles"
        " of the published micro-CT set {name}, rounded to two digits; the length unit is taken as"
        " micrometres and no measured particle is contained."
    ),
    N_("Statistics of {count} particles of {name}, made by Regolith Studio."),
    N_("noise of sampling, split {split}"),
    N_("split {split} of {total}"),
    N_("{name}, split {split}, fit"),
    N_("{name}, split {split}, draw {draw}"),
    N_(
        "{count} measured particles at l_max = {degree}, {left} left out; fitted to one half, judged on the"
        " other; {splits} {split}, {draws} draws once from each fit, seed {seed}."
    ),
    N_(
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
PARTS = (N_("size"), N_("box"), N_("sphericity"))
"""Terms of a loss as the study of the trade-off names them."""
TARGETS = (
    *(N_("yes"), N_("no"), N_("number"), N_("volume"), N_("split"), N_("splits")),
    N_("aspect ratio, times nearer than the paper's model"),
    N_("r_eq, A, AR, S: the worst, over the 95th percentile of noise"),
    N_("V/CH: Kolmogorov-Smirnov distance in floors"),
    N_("pairs of r_eq, A, AR: the largest energy distance [%]"),
    N_("draws thrown away [%]"),
    N_("median novelty"),
    *(N_("measured particles"), N_("figures")),
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
