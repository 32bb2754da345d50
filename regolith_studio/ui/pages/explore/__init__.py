"""Page "Explore": one particle in three linked views, with every choice at hand and every number below."""

from regolith_studio.messages import N_
from regolith_studio.scene.cameras import DIRECTIONS
from regolith_studio.ui.page import BREAK, VIEW, ActionSpec, Page

_DIRECTION_KEYS = {"isometric": "Ctrl+0", "front": "Ctrl+1", "right": "Ctrl+3", "top": "Ctrl+7"}


PAGE = Page(
    key="explore",
    title=N_("Explore"),
    icon="page_explore",
    order=10,
    tip=N_("One particle, its spherical-harmonics fit and its polyhedron side by side"),
    make="regolith_studio.ui.pages.explore.page:ExplorePage",
    actions=(
        ActionSpec(
            "link",
            N_("&Link cameras"),
            icon="link",
            shortcut="Ctrl+L",
            tip=N_("Rotate all views together"),
            checked=True,
            bar="under",
            label=N_("Link"),
            menu=VIEW,
        ),
        ActionSpec(
            "reset",
            N_("&Reset cameras"),
            icon="reset",
            shortcut="Ctrl+R",
            tip=N_("Show the whole particle"),
            bar="under",
            label=N_("Fit view"),
            menu=VIEW,
        ),
        ActionSpec("list", N_("Particle l&ist"), tip=N_("Show the open particles"), checked=True, menu=VIEW),
        *(
            ActionSpec(
                f"look_{key}", each.label, shortcut=_DIRECTION_KEYS.get(key, ""), menu=N_("Look &from")
            )
            for key, each in DIRECTIONS.items()
        ),
        ActionSpec(BREAK, menu=VIEW),
        ActionSpec(
            "wireframe",
            N_("&Wireframe"),
            icon="wireframe",
            shortcut="Ctrl+M",
            tip=N_("Show triangles"),
            checked=False,
            bar="under",
            label=N_("Triangles"),
            menu=VIEW,
        ),
        ActionSpec(
            "heat",
            N_("&Distance map"),
            icon="heat",
            shortcut="Ctrl+D",
            tip=N_("Colour the fit by its distance from the particle"),
            checked=False,
            bar="under",
            label=N_("Distances"),
            menu=VIEW,
        ),
        ActionSpec(
            "overlay",
            N_("&Overlay"),
            icon="overlay",
            tip=N_("One surface over another"),
            checked=False,
            bar="under",
            label=N_("Overlay"),
            menu=VIEW,
        ),
        ActionSpec(
            "wipe",
            N_("Wi&pe"),
            icon="wipe",
            shortcut="Ctrl+I",
            tip=N_("Two surfaces on either side of a line"),
            checked=False,
            bar="under",
            label=N_("Wipe"),
            menu=VIEW,
        ),
        ActionSpec(
            "section",
            N_("Cross-s&ection"),
            icon="section",
            shortcut="Ctrl+K",
            tip=N_("Cut all views"),
            checked=False,
            bar="under",
            label=N_("Section"),
            menu=VIEW,
        ),
        ActionSpec(
            "box",
            N_("&Bounding box"),
            icon="box",
            shortcut="Ctrl+B",
            tip=N_("The minimum-volume bounding box"),
            checked=False,
            bar="under",
            label=N_("Box"),
            menu=VIEW,
        ),
        ActionSpec(
            "star_point",
            N_("Star &point"),
            icon="star",
            tip=N_("The star point and the surface hidden from it"),
            checked=False,
            bar="under",
            label=N_("Star point"),
            menu=VIEW,
        ),
        ActionSpec(
            "enlarge",
            N_("&Enlarge one view"),
            shortcut="Ctrl+Shift+M",
            tip=N_("Shows one view enlarged, then the next, then all"),
            menu=VIEW,
        ),
        ActionSpec(
            "change_unit",
            N_("Change length &unit …"),
            tip=N_("Read the files of the chosen particle in another unit"),
        ),
        ActionSpec(
            "save_picture",
            N_("Save &picture …"),
            icon="camera",
            shortcut="Ctrl+P",
            tip=N_("PNG"),
            bar="under",
            label=N_("Picture"),
        ),
        ActionSpec("save_animation", N_("Save &animation of l_max …"), tip=N_("GIF of l_max 0 to 30")),
    ),
)
