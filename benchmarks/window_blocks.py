"""What keeps the window from answering: a visit to every page, action by action, with a heartbeat."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from benchmarks.window_driving import settle, spin, until
from benchmarks.window_heartbeat import LATE, Gap, Heartbeat

Act = Callable[[Any], object]


@dataclass(frozen=True)
class Block:
    """An action, and the gaps above :data:`LATE` from its beginning until the window is at rest."""

    title: str
    gaps: tuple[Gap, ...]

    def __str__(self) -> str:
        first, *others = (str(gap) for gap in self.gaps) if self.gaps else ("-",)
        return "\n".join([f"{self.title:<34} {first}", *(f"{'':<34} {other}" for other in others[:3])])


def blocks(window: Any) -> Iterator[Block]:
    """Do one thing after the other, each until the window is at rest."""
    with Heartbeat() as heart:
        for title, act in acts().items():
            settle(window)
            spin(0.1)
            heart.restart()
            act(window)
            settle(window)
            spin(0.05)
            yield Block(title, tuple(heart.gaps(LATE)))


def acts() -> dict[str, Act]:
    """What a user does, in this order."""
    return {
        "another particle": lambda window: window.session.select(window.session.particles[3].id),
        "drag l_max": lambda window: _drag(window, "l_max", range(2, 29, 2)),
        "drag the number of facets": lambda window: _drag(window, "n_facets", range(10, 40, 3)),
        "annealing": lambda window: window.session.choose(method="annealing"),
        "distance map": lambda window: _commands(window, "explore.heat"),
        "overlay, wipe, section, box, point": _marks,
        "undo ten times": lambda window: [window.session.undo() for _ in range(10)],
        "every tab of the plots": _tabs,
        "first visit to Sample": lambda window: window.pages.go("sample"),
        "every particle of Sample": _each_particle,
        "first visit to Scan": lambda window: window.pages.go("scan"),
        "open the shipped scan": _open_scan,
        "find grains": _find_grains,
        "first visit to Shape model": lambda window: window.pages.go("model"),
        "fit a model": _fit,
        "draw 1,000 particles": _draw,
        "every tab of Shape model": _tabs,
        "first visit to Studies": lambda window: window.pages.go("studies"),
        "study of l_max": lambda window: window.session.start_study("lmax_study"),
        "gallery of polyhedra": lambda window: window.go("studies").draw_gallery(),
        "every tab of Studies": _tabs,
        "first visit to Dataset": lambda window: window.pages.go("dataset"),
        "find representatives": lambda window: window.go("dataset").find_representatives(),
        "every tab of Dataset": _tabs,
        "first visit to Angle of repose": lambda window: window.pages.go("repose"),
        "every tab of Angle of repose": _tabs,
        "first visit to Lecture": lambda window: window.pages.go("lecture"),
        "every tab of Lecture": _tabs,
        "back to every page": _round,
        "the other theme": lambda window: window.appearance.choose(theme="dark"),
        "copy for recovery": lambda window: window.projects._autosave(),
    }


def _drag(window: Any, name: str, values: range) -> None:
    for value in values:
        window.session.choose(name, **{name: value})
        spin(0.05)
    window.session.end_step()


def _commands(window: Any, *names: str) -> None:
    for name in names:
        window.menus.by_name[name].trigger()
        spin(0.3)


def _marks(window: Any) -> None:
    names = [f"explore.{name}" for name in ("overlay", "wipe", "section", "box", "star_point")]
    _commands(window, *names, *reversed(names))


def _tabs(window: Any) -> None:
    from PySide6.QtWidgets import QTabWidget

    for tabs in window.page.findChildren(QTabWidget):
        if tabs.isVisible():
            for at in range(tabs.count()):
                tabs.setCurrentIndex(at)
                spin(0.2)


def _each_particle(window: Any) -> None:
    for entry in window.session.particles:
        window.session.select(entry.id)
        spin(0.2)


def _open_scan(window: Any) -> None:
    page = window.page
    page.opening.open_sample()
    until(lambda: page.scan is not None)


def _find_grains(window: Any) -> None:
    page = window.page
    page.find_grains()
    until(lambda: page.grains is not None)


def _fit(window: Any) -> None:
    page = window.page
    page.fit_model()
    until(lambda: page._fitted is not None)


def _draw(window: Any) -> None:
    page = window.page
    page.drawing.setValue(page.drawing.value() | {"n": 1_000})
    page.draw()
    until(lambda: page._drawn is not None)


def _round(window: Any) -> None:
    for key in window.pages.pages:
        window.go(key)
        spin(0.3)
