"""Page "Explore": one particle in three linked views, with every choice at hand and every number below."""

from regolith_studio.scene.cameras import DIRECTIONS
from regolith_studio.ui.action_spec import BREAK, PAGE_MENU, ActionSpec
from regolith_studio.ui.page import Page, PageContext, PageWidget

_DIRECTION_KEYS = {"isometric": "Ctrl+0", "front": "Ctrl+1", "right": "Ctrl+3", "top": "Ctrl+7"}


def build(context: PageContext) -> PageWidget:
    """The page's widget."""
    from regolith_studio.ui.pages.explore.page import ExplorePage

    return ExplorePage(context)


PAGE = Page(
    key="explore",
    title="Explore",
    icon="page_explore",
    order=10,
    tip="One particle, its spherical-harmonics fit and its polyhedron side by side",
    make=build,
    actions=(
        ActionSpec(
            "&View", "link", "&Link cameras", "link", "Ctrl+L", "Turn all views together", True, "icon"
        ),
        ActionSpec(
            "&View", "reset", "&Reset cameras", "reset", "Ctrl+R", "Show the whole particle", bar="icon"
        ),
        *(
            ActionSpec("Look &from", f"look_{key}", each.label, "", _DIRECTION_KEYS.get(key, ""))
            for key, each in DIRECTIONS.items()
        ),
        ActionSpec("&View", BREAK, ""),
        ActionSpec(
            "&View", "wireframe", "&Wireframe", "wireframe", "Ctrl+M", "Show triangles", False, "icon"
        ),
        ActionSpec("&View", "heat", "&Distance map", "heat", "Ctrl+D", "Show fitting errors", False, "icon"),
        ActionSpec("&View", "overlay", "&Overlay", "overlay", "", "One body over another", False, "icon"),
        ActionSpec("&View", "wipe", "Wi&pe", "wipe", "Ctrl+I", "Two bodies beside a line", False, "icon"),
        ActionSpec("&View", "section", "Cross-s&ection", "section", "Ctrl+K", "Cut all views", False, "icon"),
        ActionSpec("&View", "box", "&Bounding box", "box", "Ctrl+B", "Smallest in volume", False, "icon"),
        ActionSpec("&View", "star_point", "Star &point", "star", "", "And what it cannot see", False, "icon"),
        ActionSpec(
            "&View", "enlarge", "&Enlarge one view", "", "Ctrl+Shift+M", "One after the other, then all"
        ),
        ActionSpec(PAGE_MENU, "save_picture", "Save &picture …", "camera", "Ctrl+P", "PNG", bar="icon"),
        ActionSpec(PAGE_MENU, "save_turntable", "Save &turntable …", tip="One turn: GIF, WebP, PNG files"),
        ActionSpec(PAGE_MENU, "save_animation", "Save &animation of l_max …", tip="GIF of l_max 0 to 30"),
    ),
)
