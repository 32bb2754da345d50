"""What a lesson says: sentences and formulas with their numbers filled in. Pure."""

from collections.abc import Sequence

from regolith_studio.coarsening.evaluation import Evaluation
from regolith_studio.coarsening.methods.annealing import AnnealingSettings
from regolith_studio.coarsening.weights import JACCARD, LossWeights
from regolith_studio.descriptors.catalogue import CATALOGUE, LOSS_KEYS
from regolith_studio.jobs.lecturing import AnnealingLesson, AnnealingStep, DegreeStep

TERMS = (JACCARD, *LOSS_KEYS)
REFUSED, ACCEPTED, LUCKY, START = "refused", "accepted", "lucky", "start"
DEGREE = "l<sub>max</sub>"
"""As rich text."""
A_LINE = 4
"""Terms of the loss on one line."""
GENERAL_LOSS = r"$L=\alpha_J\,J+\sum_i\alpha_i\,\varepsilon_i$"
GENERAL_SERIES = r"$r(\theta,\varphi)=\sum_{l=0}^{l_{max}}\,\sum_{m=-l}^{l}c_{lm}\,Y_{lm}(\theta,\varphi)$"


def symbol(key: str) -> str:
    """A term of the loss in mathtext, without dollars."""
    if key == JACCARD:
        return "J"
    head, _, tail = CATALOGUE[key].symbol.partition("_")
    return f"{head}_{{{tail}}}" if tail else head


def plain(key: str) -> str:
    """A term of the loss for an axis."""
    return "J" if key == JACCARD else CATALOGUE[key].symbol.replace("_", "")


def terms_of(weights: LossWeights, found: Evaluation) -> dict[str, float]:
    """Weight times error of each term that has a weight (Eq. 9)."""
    values = {JACCARD: found.jaccard_distance, **found.errors}
    return {key: weights[key] * values[key] for key in TERMS if weights[key]}


def loss_lines(weights: LossWeights, found: Evaluation) -> tuple[str, ...]:
    """Eq. 9, and Eq. 9 with its numbers."""
    values = {JACCARD: found.jaccard_distance, **found.errors}
    parts = [
        rf"{weights[key]:g}\cdot{_number(values[key])}_{{\,{symbol(key)}}}" for key in TERMS if weights[key]
    ]
    total = rf"={_number(found.loss)}$"
    if len(parts) <= A_LINE:
        return (GENERAL_LOSS, "$L=" + "+".join(parts) + total)
    first, rest = "+".join(parts[:A_LINE]), "+".join(parts[A_LINE:])
    return (GENERAL_LOSS, f"$L={first}$", rf"$\quad +{rest}{total}")


def temperature_line(settings: AnnealingSettings, k: int) -> str:
    """T(k) with its numbers."""
    probability = settings.acceptance_probability(k)
    return (
        rf"$T(k)=T_0\,\gamma^{{\,k}}={settings.start_temperature:g}\cdot {settings.cooling:g}^{{\,{k}}}"
        rf"={_number(probability)}$"
    )


def proposal_line(step: AnnealingStep, lesson: AnnealingLesson) -> str:
    """The normal step of one point."""
    if step.move is None:
        return r"$p_i^{\prime}\sim N(p_i,\,\sigma),\quad \sigma=\frac{1}{n}\sum_j|p_j|$"
    i, sigma = step.move.plane + 1, step.move.sigma * lesson.scale
    return (
        rf"$p_{{{i}}}^{{\prime}}\sim N(p_{{{i}}},\,\sigma),\quad \sigma={_number(sigma)}\;\mu m,\quad"
        rf" |p_{{{i}}}^{{\prime}}-p_{{{i}}}|={_number(step.distance)}\;\mu m$"
    )


def decision_line(step: AnnealingStep) -> str:
    """The comparison that decides."""
    move = step.move
    if move is None:
        return r"$\Delta L<0\;$ or $\;u<T(k)\quad\Rightarrow\quad$ accept"
    if move.proposed is None:
        return r"no polyhedron $\quad\Rightarrow\quad$ refuse"
    change = move.proposed.loss - move.before.loss
    if move.better:
        return rf"$\Delta L={_signed(change)}<0\quad\Rightarrow\quad$ accept"
    sign, end = ("<", "accept") if move.accepted else (r"\geq ", "refuse")
    drawn = rf"u={_number(move.drawn)}{sign}T(k)"
    return rf"$\Delta L={_signed(change)}\geq 0,\quad {drawn}\quad\Rightarrow\quad$ {end}"


def mood_of(step: AnnealingStep) -> str:
    """How a step ended: one of the moods of this module."""
    if step.move is None:
        return START
    if not step.move.accepted:
        return REFUSED
    return ACCEPTED if step.move.better else LUCKY


def sentence_of(step: AnnealingStep, lesson: AnnealingLesson) -> str:
    """What happened, in words."""
    move = step.move
    if move is None:
        return (
            f"The start: the convex hull, decimated to {lesson.n_faces} planes. In each step one plane is"
            " moved at random, and the move is taken or not."
        )
    moved = f"Plane {move.plane + 1} of {len(move.points)} is moved by {step.distance:.3g} µm"
    if step.facet is None:
        moved += ", one that bounds no facet at the moment"
    if move.proposed is None:
        return f"{moved}: the half-spaces bound no polyhedron any more. Refused without asking T(k)."
    losses = f"from {_number(move.before.loss)} to {_number(move.proposed.loss)}"
    if move.better:
        return f"{moved}: the loss falls {losses}. Better, so it is accepted."
    how = "stays what it is" if move.proposed.loss == move.before.loss else f"rises {losses}"
    chance = f"{move.probability:.2%}"
    if move.accepted:
        return f"{moved}: the loss {how}. Accepted all the same: luck, of which there was {chance}."
    return f"{moved}: the loss {how}. Refused; there was a chance of {chance} that it would have been taken."


def degree_lines(step: DegreeStep) -> tuple[str, ...]:
    """Eq. 4 with its numbers."""
    count = (step.l_max + 1) ** 2
    return (
        GENERAL_SERIES,
        rf"$l_{{max}}={step.l_max}:\quad (l_{{max}}+1)^2={count}$ coefficients,"
        rf"$\quad \frac{{c_{{00}}}}{{\sqrt{{4\pi}}}}={_number(step.mean_radius)}\;\mu m$",
    )


def degree_sentence(step: DegreeStep) -> str:
    """What the fit keeps at a degree, in words."""
    if step.mesh is None:
        return f"At {DEGREE} = {step.l_max} the series has a negative radius somewhere: it is no surface."
    names = {0: "a sphere", 1: "a sphere that is shifted a little", 2: "nearly an ellipsoid"}
    shape = names.get(step.l_max, "finer and finer bumps")
    errors = ", ".join(f"{CATALOGUE[key].label.lower()} {value:.1%}" for key, value in step.errors.items())
    return (
        f"{DEGREE} = {step.l_max}: {shape}. The radius is missed by {step.radial_error:.1%} in the root mean"
        f" square; errors against the particle: {errors}."
    )


def field_lines(amplitudes: Sequence[float]) -> tuple[str, ...]:
    """The field of logarithms of radii with the amplitudes filled in."""
    shown = [rf"{100 * value:.2g}\%_{{\,{degree}}}" for degree, value in enumerate(amplitudes, start=1)]
    listed = r",\;".join(shown[:6] + ([r"\ldots"] if len(shown) > 6 else []))
    return (
        r"$\ln\frac{r(\theta,\varphi)}{\bar{r}}=\sum_{l=1}^{l_{max}}\sum_{m=-l}^{l}\sqrt{A_l}\;z_{lm}\,"
        r"Y_{lm}(\theta,\varphi),\quad z_{lm}\sim N(0,1)$",
        rf"$\sqrt{{A_l/4\pi}}={listed}$",
    )


def _number(value: float) -> str:
    if abs(value) >= 1e-3:
        return f"{value:.3g}"
    return f"{value:.4f}" if abs(value) >= 5e-5 else "0"


def _signed(value: float) -> str:
    return f"{value:+.3g}" if abs(value) >= 1e-9 else "0"


def exact_terms(lesson: AnnealingLesson) -> dict[str, float]:
    """The terms of Eq. 9 that the exact method reaches."""
    if lesson.exact is None:
        return {}
    values = {JACCARD: lesson.exact.jaccard_distance, **lesson.exact.errors}
    return {key: lesson.weights[key] * values[key] for key in TERMS if lesson.weights[key]}


def exact_lines(lesson: AnnealingLesson) -> tuple[str, ...]:
    """Eq. 9 of the exact method with its numbers."""
    exact = lesson.exact
    if exact is None:
        return ()
    found = Evaluation(dict(exact.errors), exact.jaccard_distance, exact.loss)
    return loss_lines(lesson.weights, found)[1:]
