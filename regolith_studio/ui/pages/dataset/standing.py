"""What a recipe says of a dataset, and the controls that say it."""

from dataclasses import dataclass

from regolith_studio.session.recipe_dataset import Standing
from regolith_studio.ui.pages.dataset.controls import FolderPanel, RepresentativesPanel, SizesPanel
from regolith_studio.ui.pages.dataset.targets import TargetsPanel


@dataclass(frozen=True)
class Controls:
    """The panels at the left of the page."""

    representatives: RepresentativesPanel
    sizes: SizesPanel
    folder: FolderPanel
    targets: TargetsPanel

    def take(self, opened: Standing) -> None:
        """Set them as a recipe says."""
        if wish := opened.representatives:
            self.representatives.setValue(wish.model_dump())
            self.sizes.set_text(wish.sizes)
            self.folder.name.setText(wish.name or self.folder.name.text())
        if opened.exports:
            self.targets.take(opened.exports)

    def standing(self) -> Standing:
        """What a recipe would say."""
        name = self.folder.name.text().strip()
        return Standing(self.representatives.wish(self.sizes.text(), name), self.targets.wish())
