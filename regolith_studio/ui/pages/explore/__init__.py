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
            N_("Rotate all views together"),
            True,
            bar="under",
            label=N_("Link"),
        ),
        ActionSpec(
            N_("&View"),
            "reset",
            N_("&Reset cameras"),
            "reset",
            "Ctrl+R",
            N_("Show the whole particle"),
            bar="under",
            label=N_("Fit view"),
        ),
        ActionSpec(N_("&View"), "list", N_("Particle l&ist"), "", "", N_("Show the open particles"), True),
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
            bar="under",
            label=N_("Triangles"),
        ),
        ActionSpec(
            N_("&View"),
            "heat",
            N_("&Distance map"),
            "heat",
            "Ctrl+D",
            N_("Colour the fit by its distance from the particle"),
            False,
            bar="under",
            label=N_("Distances"),
        ),
        ActionSpec(
            N_("&View"),
            "overlay",
            N_("&Overlay"),
            "overlay",
            "",
            N_("One surface over another"),
            False,
            bar="under",
            label=N_("Overlay"),
        ),
        ActionSpec(
            N_("&View"),
            "wipe",
            N_("Wi&pe"),
            "wipe",
            "Ctrl+I",
            N_("Two surfaces on either side of a line"),
            False,
            bar="under",
            label=N_("Wipe"),
        ),
        ActionSpec(
            N_("&View"),
            "section",
            N_("Cross-s&ection"),
            "section",
            "Ctrl+K",
            N_("Cut all views"),
            False,
            bar="under",
            label=N_("Section"),
        ),
        ActionSpec(
            N_("&View"),
            "box",
            N_("&Bounding box"),
            "box",
            "Ctrl+B",
            N_("The minimum-volume bounding box"),
            False,
            bar="under",
            label=N_("Box"),
        ),
        ActionSpec(
            N_("&View"),
            "star_point",
            N_("Star &point"),
            "star",
            "",
            N_("The star point and the surface hidden from it"),
            False,
            bar="under",
            label=N_("Star point"),
        ),
        ActionSpec(
            N_("&View"),
            "enlarge",
            N_("&Enlarge one view"),
            "",
            "Ctrl+Shift+M",
            N_("Shows one view enlarged, then the next, then all"),
        ),
        ActionSpec(
            PAGE_MENU,
            "change_unit",
            N_("Change length &unit …"),
            tip=N_("Read the files of the chosen particle in another unit"),
        ),
        ActionSpec(
            PAGE_MENU,
            "save_picture",
            N_("Save &picture …"),
            "camera",
            "Ctrl+P",
            N_("PNG"),
            bar="under",
            label=N_("Picture"),
        ),
        ActionSpec(
            PAGE_MENU, "save_turntable", N_("Save &turntable …"), tip=N_("One turn: GIF, WebP, PNG files")
        ),
        ActionSpec(
            PAGE_MENU, "save_animation", N_("Save &animation of l_max …"), tip=N_("GIF of l_max 0 to 30")
        ),
    ),
)
