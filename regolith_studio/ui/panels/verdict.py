"""Loss, error and overlap of the polyhedron in large figures, and what they mean."""

from regolith_studio.session.choices import Choices
from regolith_studio.session.results import Results
from regolith_studio.session.verdict import PolyhedronVerdict, polyhedron_verdict
from regolith_studio.ui.translation import tr, translate
from regolith_studio.ui.translation.numbers import number_text
from regolith_studio.ui.widgets.headline import Headline


class VerdictPanel(Headline):
    """The result of the page Explore; dimmed while the polyhedron is being replaced."""

    def __init__(self) -> None:
        super().__init__("verdict", (tr("Loss"), "RMSRE", tr("Jaccard distance")))
        tips = (
            tr("Weighted sum of the Jaccard distance and the relative errors (Eq. 9)"),
            tr("Root mean squared relative error over the descriptors that have a weight (Eq. 10)"),
            tr("1 - shared volume / united volume (Eq. 7)"),
        )
        for place, tip in enumerate(tips):
            self.caption(place, self.captions[place].text(), tip)
        self._shown: PolyhedronVerdict | None = None
        self._particle = ""

    def show_results(self, results: Results, choices: Choices) -> None:
        """Show the verdict on the finished polyhedron."""
        done = results.coarsened
        if done is not None:
            self._particle = choices.selected
            self._shown = polyhedron_verdict(
                done, choices.weights, results.against_particle, results.fewer_facets
            )
        elif results.best is None or choices.selected != self._particle:
            self._shown = None
        found = self._shown
        if found is None:
            why = translate(results.failures.get("coarsening", ""))
            self.show_values(("–",) * 3, why or tr("The polyhedron is not finished yet."), fresh=False)
            return
        error = "–" if found.rmsre != found.rmsre else number_text(found.rmsre, ".2%")
        figures = (number_text(found.loss, "#.4g"), error, number_text(found.jaccard_distance, ".1%"))
        self.show_values(figures, translate(found.sentence), fresh=done is not None)
