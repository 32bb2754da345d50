"""Page "Explore": one particle in three linked views, with every choice at hand and every number below."""

from regolith_studio.messages import N_
from regolith_studio.scene.cameras import DIRECTIONS
from regolith_studio.ui.page import BREAK, PAGE_MENU, ActionSpec, Page, PageContext, PageWidget

_DIRECTION_KEYS = {"isometric": "Ctrl+0", "front": "Ctrl+1", "right": "Ctrl+3", "top": "Ctrl+7"}


def build(context: PageContext) -> PageWidget:
    """The page's widget."""
    from regolith_studio.ui.pages.explore.page import ExplorePage

    return ExplorePage(context)


PAGE = Page(
    key="explore",
    title=N_("Explore"),
    icon="page_explore",
    order=10,
    tip=N_("One particle, its spherical-harmonics fit and its polyhedron side by side"),
    make=build,
    actions=(
        ActionSpec(
            N_("&View"),
            "link",
            N_("&Link cameras"),
            "link",
            "Ctrl+L",
            N_("Turn all views together"),
            True,
            "icon",
        ),
        ActionSpec(
            N_("&View"),
            "reset",
            N_("&Reset cameras"),
            "reset",
            "Ctrl+R",
            N_("Show the whole particle"),
            bar="icon",
        ),
        ActionSpec(N_("&View"), "list", N_("&Particle list"), "", "", N_("Show the open particles"), True),
        *(
            ActionSpec(N_("Look &from"), f"look_{key}", each.label, "", _DIRECTION_KEYS.get(key, ""))
            for key, each in DIRECTIONS.items()
        ),
        ActionSpec(N_("&View"), BREAK, ""),
        ActionSpec(
            N_("&View"),
            "wireframe",
            N_("&Wireframe"),
            "wireframe",
            "Ctrl+M",
            N_("Show triangles"),
            False,
            "icon",
        ),
        ActionSpec(
            N_("&View"),
            "heat",
            N_("&Distance map"),
            "heat",
            "Ctrl+D",
            N_("Show fitting errors"),
            False,
            "icon",
        ),
        ActionSpec(
            N_("&View"), "overlay", N_("&Overlay"), "overlay", "", N_("One body over another"), False, "icon"
        ),
        ActionSpec(
            N_("&View"), "wipe", N_("Wi&pe"), "wipe", "Ctrl+I", N_("Two bodies beside a line"), False, "icon"
        ),
        ActionSpec(
            N_("&View"),
            "section",
            N_("Cross-s&ection"),
            "section",
            "Ctrl+K",
            N_("Cut all views"),
            False,
            "icon",
        ),
        ActionSpec(
            N_("&View"), "box", N_("&Bounding box"), "box", "Ctrl+B", N_("Smallest in volume"), False, "icon"
        ),
        ActionSpec(
            N_("&View"),
            "star_point",
            N_("Star &point"),
            "star",
            "",
            N_("And what it cannot see"),
            False,
            "icon",
        ),
        ActionSpec(
            N_("&View"),
            "enlarge",
            N_("&Enlarge one view"),
            "",
            "Ctrl+Shift+M",
            N_("One after the other, then all"),
        ),
        ActionSpec(
            PAGE_MENU, "save_picture", N_("Save &picture …"), "camera", "Ctrl+P", N_("PNG"), bar="icon"
        ),
        ActionSpec(
            PAGE_MENU, "save_turntable", N_("Save &turntable …"), tip=N_("One turn: GIF, WebP, PNG files")
        ),
        ActionSpec(
            PAGE_MENU, "save_animation", N_("Save &animation of l_max …"), tip=N_("GIF of l_max 0 to 30")
        ),
    ),
)
