"""Texts and formulas of the lessons with their numbers filled in."""

from collections.abc import Sequence

from regolith_studio.coarsening.loss import Evaluation
from regolith_studio.coarsening.methods.annealing import AnnealingSettings
from regolith_studio.coarsening.progress import Move
from regolith_studio.coarsening.weights import JACCARD, LossWeights
from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.jobs.lecture_jobs import AnnealingLesson, AnnealingStep, DegreeStep
from regolith_studio.ui.translation import Markup, in_a_sentence, number_text, tr
from regolith_studio.ui.widgets.formula import BREAK
from regolith_studio.ui.widgets.labels import plain_symbol

TERMS = (JACCARD, *LOSS_KEYS)
ROUNDING = 1e-9
"""Difference of losses below which they are equal but for rounding."""
REFUSED, ACCEPTED, LUCKY, START = "refused", "accepted", "lucky", "start"
"""Outcomes of a step."""
DEGREE = Markup("l<sub>max</sub>")
GENERAL_LOSS = r"$L=\alpha_J\,J+\sum_i\alpha_i\,\varepsilon_i$"
GENERAL_SERIES = r"$r(\theta,\varphi)=\sum_{l=0}^{l_{max}}\,\sum_{m=-l}^{l}c_{lm}\,Y_{lm}(\theta,\varphi)$"


def symbol(key: str) -> str:
    """A term of the loss in mathtext, without dollars."""
    if key == JACCARD:
        return "J"
    head, _, tail = CATALOGUE[key].symbol.partition("_")
    return f"{head}_{{{tail}}}" if tail else head


def plain(key: str) -> str:
    return "J" if key == JACCARD else plain_symbol(CATALOGUE[key].symbol)


def terms_of(weights: LossWeights, found: Evaluation) -> dict[str, float]:
    """Weight times error of each term that has a weight (Eq. 9)."""
    values = {JACCARD: found.jaccard_distance, **found.errors}
    return {key: weights[key] * values[key] for key in TERMS if weights[key]}


def loss_lines(weights: LossWeights, found: Evaluation) -> tuple[str, ...]:
    """Eq. 9, and Eq. 9 with its numbers; a weight of 1 is not written, nor an error that rounds to 0."""
    values = {JACCARD: found.jaccard_distance, **found.errors}
    parts = [
        rf"{_factor(weights[key])}{_number(values[key])}_{{\,{symbol(key)}}}"
        for key in TERMS
        if weights[key] and _number(values[key]) != "0"
    ] or ["0"]
    pieces = [f"$L={parts[0]}$", *(f"$+{part}$" for part in parts[1:]), rf"$={_number(found.loss)}$"]
    return (GENERAL_LOSS, BREAK.join(pieces))


def _factor(weight: float) -> str:
    return "" if weight == 1.0 else rf"{_in_formula(weight)}\cdot "


def temperature_line(settings: AnnealingSettings, k: int) -> str:
    probability = settings.acceptance_probability(k)
    start, cooling = _in_formula(settings.start_temperature), _in_formula(settings.cooling)
    return (
        rf"$T(k)=T_0\,\gamma^{{\,k}}={start}\cdot {cooling}^{{\,{k}}}"
        rf"={_number(probability)}$"
    )


def proposal_line(step: AnnealingStep, lesson: AnnealingLesson) -> str:
    if step.move is None:
        return r"$p_i^{\prime}\sim N(p_i,\,\sigma),\quad \sigma=\frac{1}{n}\sum_j|p_j|$"
    i, sigma = step.move.plane + 1, step.move.sigma * lesson.scale
    return (
        rf"$p_{{{i}}}^{{\prime}}\sim N(p_{{{i}}},\,\sigma),$"
        rf"{BREAK}$\;\sigma={_number(sigma)}\;\mu m,${BREAK}"
        rf"$\;|p_{{{i}}}^{{\prime}}-p_{{{i}}}|={_number(step.distance)}\;\mu m$"
    )


def rule_lines(step: AnnealingStep, lesson: AnnealingLesson) -> tuple[str, ...]:
    """Proposal, T(k) and decision of a step with their numbers."""
    temperature = temperature_line(lesson.settings, step.number)
    return (proposal_line(step, lesson), temperature, decision_line(step))


def decision_line(step: AnnealingStep) -> str:
    move = step.move
    if move is None:
        return r"$\Delta L<0\;$ " + tr("or") + r" $\;u<T(k)\quad\Rightarrow\quad$ " + tr("accept")
    if move.proposed is None:
        return tr("no polyhedron") + r" $\quad\Rightarrow\quad$ " + tr("reject")
    change = move.proposed.loss - move.before.loss
    if _falls(move):
        return rf"$\Delta L={_signed(change)}<0\quad\Rightarrow\quad$ " + tr("accept")
    if move.better:
        return r"$\Delta L=0\quad\Rightarrow\quad$ " + tr("accept")
    sign, end = ("<", tr("accept")) if move.accepted else (r"\geq ", tr("reject"))
    drawn = rf"u={_number(move.drawn)}{sign}T(k)"
    return rf"$\Delta L={_signed(change)}\geq 0,${BREAK}$\;{drawn}${BREAK}$\;\Rightarrow\;$ {end}"


def _falls(move: Move) -> bool:
    """Whether the loss falls by more than rounding, as where a plane that bounds no facet is moved."""
    return move.proposed is not None and move.before.loss - move.proposed.loss >= ROUNDING


def outcome_of(step: AnnealingStep) -> str:
    """Outcome of a step, one of the constants of this module."""
    if step.move is None:
        return START
    if not step.move.accepted:
        return REFUSED
    return ACCEPTED if step.move.better else LUCKY


def sentence_of(step: AnnealingStep, lesson: AnnealingLesson) -> str:
    move = step.move
    if move is None:
        return tr(
            "The start: the convex hull, decimated to {count} planes. In each step one plane is moved at"
            " random, and the move is accepted or rejected.",
            count=lesson.n_facets,
        )
    moved = tr(
        "Plane {number} of {count} is moved by {distance:.3g} µm",
        number=move.plane + 1,
        count=len(move.points),
        distance=step.distance,
    )
    if step.facet is None:
        moved += tr(", a redundant plane")
    if move.proposed is None:
        return tr(
            "{moved}: the half-spaces bound no polyhedron any more. Rejected without drawing u.", moved=moved
        )
    losses = dict(zip(("before", "after"), _apart(move.before.loss, move.proposed.loss), strict=True))
    if move.better and not _falls(move):
        return tr("{moved}: the loss does not change. Not larger, so it is accepted.", moved=moved)
    if move.better:
        return tr(
            "{moved}: the loss falls from {before} to {after}. Better, so it is accepted.",
            moved=moved,
            **losses,
        )
    same = abs(move.proposed.loss - move.before.loss) < ROUNDING
    how = tr("does not change") if same else tr("rises from {before} to {after}", **losses)
    chance = number_text(move.probability, ".2%")
    if move.accepted:
        return tr(
            "{moved}: the loss {how}. Accepted with probability {chance}.",
            moved=moved,
            how=how,
            chance=chance,
        )
    return tr(
        "{moved}: the loss {how}. Rejected; the acceptance probability was {chance}.",
        moved=moved,
        how=how,
        chance=chance,
    )


def degree_lines(step: DegreeStep) -> tuple[str, ...]:
    count = (step.l_max + 1) ** 2
    noun = tr("coefficient") if count == 1 else tr("coefficients")
    return (
        GENERAL_SERIES,
        rf"$l_{{max}}={step.l_max}:$ {BREAK}$\;(l_{{max}}+1)^2={count}$ " + noun + f",{BREAK}"
        rf"$\;\frac{{c_{{00}}}}{{\sqrt{{4\pi}}}}={_number(step.mean_radius)}\;\mu m$",
    )


def degree_sentence(step: DegreeStep) -> str:
    if step.mesh is None:
        return tr(
            "At {symbol} = {degree} the series has a negative radius somewhere and describes no surface.",
            symbol=DEGREE,
            degree=step.l_max,
        )
    names = {0: tr("a sphere"), 1: tr("a slightly displaced sphere"), 2: tr("nearly an ellipsoid")}
    shape = names.get(step.l_max, tr("finer details"))
    errors = ", ".join(
        f"{in_a_sentence(CATALOGUE[key].label)} {number_text(value, '.1%')}"
        for key, value in step.errors.items()
    )
    return tr(
        "{symbol} = {degree}: {shape}. RMS radius error {missed:.1%}; errors against the particle: {errors}.",
        symbol=DEGREE,
        degree=step.l_max,
        shape=shape,
        missed=step.radial_error,
        errors=errors,
    )


def field_lines(amplitudes: Sequence[float]) -> tuple[str, ...]:
    """The field of logarithms of radii with the amplitudes filled in."""
    shown = [
        rf"{_in_formula(100 * value, '.2g')}\%_{{\,{degree}}}"
        for degree, value in enumerate(amplitudes, start=1)
    ]
    listed = rf",${BREAK}$\;".join(shown[:6] + ([r"\ldots"] if len(shown) > 6 else []))
    return (
        r"$\ln\frac{r(\theta,\varphi)}{\bar{r}}=\sum_{l=1}^{l_{max}}\sum_{m=-l}^{l}\sqrt{A_l}\;z_{lm}\,"
        rf"Y_{{lm}}(\theta,\varphi),${BREAK}$\;"
        r"z_{lm}\sim N(0,1)$",
        rf"$\sqrt{{A_l/4\pi}}={listed}$",
    )


def _apart(one: float, other: float) -> tuple[str, str]:
    """Two different numbers with as many digits as tell them apart."""
    pairs = [(number_text(one, f".{digits}g"), number_text(other, f".{digits}g")) for digits in range(3, 17)]
    return next((pair for pair in pairs if pair[0] != pair[1]), pairs[0])


def _number(value: float) -> str:
    if abs(value) >= 1e-3:
        return _in_formula(value, ".3g")
    return _in_formula(value, ".4f") if abs(value) >= 5e-5 else "0"


def _signed(value: float) -> str:
    return _in_formula(value, "+.3g") if abs(value) >= ROUNDING else "0"


def _in_formula(value: float, form: str = "g") -> str:
    """A number in TeX, whose comma would be followed by a space without braces."""
    return number_text(value, form).replace(",", "{,}")


def exact_terms(lesson: AnnealingLesson) -> dict[str, float]:
    """The terms of Eq. 9 that the exact method reaches."""
    if lesson.exact is None:
        return {}
    values = {JACCARD: lesson.exact.jaccard_distance, **lesson.exact.errors}
    return {key: lesson.weights[key] * values[key] for key in TERMS if lesson.weights[key]}


def exact_lines(lesson: AnnealingLesson) -> tuple[str, ...]:
    exact = lesson.exact
    if exact is None:
        return ()
    found = Evaluation(dict(exact.errors), exact.jaccard_distance, exact.loss)
    return loss_lines(lesson.weights, found)[1:]
