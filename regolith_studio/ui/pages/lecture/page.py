"""Page "Lecture": three lessons as tabs in a large font, computed by jobs."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication, QKeyEvent, QResizeEvent
from PySide6.QtWidgets import QPushButton, QTabWidget

from regolith_studio.jobs.events import Job
from regolith_studio.jobs.lecture_jobs import trace_annealing, trace_degrees
from regolith_studio.session.choices import PARTICLE_CHOICES
from regolith_studio.session.results import ParticleEntry
from regolith_studio.ui.layout import hbox, name_tabs, named, vbox
from regolith_studio.ui.page import PageContext, PageWidget, Sidebar
from regolith_studio.ui.pages.lecture.annealing import AnnealingView
from regolith_studio.ui.pages.lecture.lessons import DegreesView, FieldView, PlaybackBar
from regolith_studio.ui.theme import Theme, current_theme, ensure_polished, font_share
from regolith_studio.ui.translation import rich, tr
from regolith_studio.ui.widgets.fields import ChoiceBox
from regolith_studio.ui.widgets.labels import FixedHeightText, hint_label

FONT_SIZE, FEW_LINES, LETTERS_OF_FEW = 1.35, 54, 1.1
"""Initial font size relative to other pages; below so many of their lines in height, a smaller one."""
LETTERS_OF_NAME = 20
"""Room for the name of a particle."""
SMALLEST, LARGEST, STEP = 0.8, 2.4, 1.12
LESSONS = ("annealing", "degrees", "field")
PLAYING_KEYS: dict[int, str] = {
    Qt.Key.Key_Space: "play",
    Qt.Key.Key_Left: "back",
    Qt.Key.Key_Right: "forward",
}


class LecturePage(PageWidget):
    """Selects particle and lesson, and starts the job of the lesson."""

    def __init__(self, context: PageContext) -> None:
        super().__init__()
        self.setObjectName("lecture")
        self._context, self._session = context, context.session
        self._shown_size = 0.0
        self._font_scale: float | None = context.recall("font_size")
        self._made_for: dict[str, tuple[Any, ...]] = {}
        self._seed = 0

    def build(self) -> None:
        context = self._context
        views = context.views
        self.annealing, self.degrees = AnnealingView(views), DegreesView(views)
        self.field = FieldView(context)
        for lesson in (self.annealing, self.degrees, self.field):
            lesson.build()
        self.particle = ChoiceBox("lecture_particle", tr("Particle"), (), capital=False)
        self.particle.setMinimumContentsLength(LETTERS_OF_NAME)
        self.another = named(QPushButton(tr("Another seed")), "lecture_another")
        self.request = hint_label()
        self._head = (self.particle, self.another, self.request)
        self.tabs = named(QTabWidget(), "lecture_lessons")
        self._place()
        self._show_font_size()
        self.tabs.currentChanged.connect(self._turn)
        self.another.clicked.connect(self.draw_another)
        self.particle.currentIndexChanged.connect(self._select)
        context.bindings.refresh("particles choices", self._show_particles, PARTICLE_CHOICES)
        context.bindings.refresh("particles choices fit surface", self._fill, slow=True)

    # --- the page of the window ----------------------------------------------------------------

    def set_theme(self, theme: Theme) -> None:  # noqa: ARG002
        if self._shown_size not in (0.0, self._size()):  # letters of the whole window have changed
            self._show_font_size()

    def commands(self) -> Mapping[str, Callable[..., object]]:
        return {
            "play": lambda: self._control_playback(PlaybackBar.toggle),
            "back": lambda: self._control_playback(lambda each: each.go(each.step - 1)),
            "forward": lambda: self._control_playback(lambda each: each.go(each.step + 1)),
            "another": self.draw_another,
            "larger": partial(self.scale_font, STEP),
            "smaller": partial(self.scale_font, 1 / STEP),
            "full_screen": self.toggle_full_screen,
        }

    def on_show(self) -> None:
        self._fill()
        focus = self.window().focusWidget()
        unused = focus is None or not focus.isVisible() or isinstance(focus.parent(), Sidebar)
        if unused or self.isAncestorOf(focus):
            self.setFocus(Qt.FocusReason.OtherFocusReason)  # else Space would open the list of particles

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Space plays and arrows step wherever no control of the page takes them."""
        name = PLAYING_KEYS.get(event.key())
        if event.key() == Qt.Key.Key_Escape and self.window().isFullScreen():
            name = "full_screen"
        if name is None or event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier:
            super().keyPressEvent(event)
        else:
            self.commands()[name]()

    def on_hide(self) -> None:
        if self.window().isFullScreen():
            self.toggle_full_screen()
        self._pause()

    def _pause(self) -> None:
        for lesson in (self.annealing, self.degrees):
            lesson.playback.pause()

    def state(self) -> dict[str, Any]:
        return {"lesson": self.lesson, "seed": self._seed}

    def restore(self, state: Mapping[str, Any]) -> None:
        if state.get("lesson") in LESSONS:
            self.tabs.setCurrentIndex(LESSONS.index(state["lesson"]))
        if isinstance(state.get("seed"), int) and state["seed"] >= 0:
            self._seed = state["seed"]
            self._fill()

    def on_close(self) -> None:
        for lesson in (self.annealing, self.degrees, self.field):
            lesson.release()

    # --- commands ------------------------------------------------------------------------------

    @property
    def lesson(self) -> str:
        return LESSONS[self.tabs.currentIndex()]

    def draw_another(self) -> None:
        if self.lesson == "field":
            self.field.draw_another()
        elif self.lesson == "degrees":
            self._context.toast.note(tr("The series of a fit has no random numbers."))
        else:
            self._seed += 1
            before = self._made_for.get("annealing")
            self._fill()
            if self._made_for.get("annealing") == before:
                self._show_absence()

    def scale_font(self, factor: float) -> None:
        """Change the font size, which is remembered."""
        self._font_scale = min(max(self._magnification() * factor, SMALLEST), LARGEST)
        self._context.remember("font_size", self._font_scale)
        self._show_font_size()

    def toggle_full_screen(self) -> None:
        """Fill the screen with the page, without bars, or end that."""
        window = self.window()
        window.setWindowState(window.windowState() ^ Qt.WindowState.WindowFullScreen)

    # --- filling -------------------------------------------------------------------------------

    def _fill(self) -> None:
        """Start the job of the current lesson unless its results are shown already."""
        entry = self._session.selected
        self.another.setVisible(self.lesson == "annealing")
        self.request.setVisible(self.lesson == "annealing")
        if self.lesson == "field":
            if self.field.drawn is None:
                self.field.take_material()
        elif entry is None:
            self.annealing.wait(tr("Open a particle first."))
        elif self.lesson == "annealing":
            self._anneal(entry)
        else:
            self._grow(entry)

    def _anneal(self, entry: ParticleEntry) -> None:
        choices, results = self._session.choices, self._session.results
        fitted = choices.target == "fit"
        mesh = results.surface if fitted else entry.particle.mesh
        if mesh is None or (fitted and results.surface_l_max != choices.l_max):
            return
        seed = choices.seed + self._seed
        settings = choices.settings if choices.method == "annealing" else ()
        wanted = (mesh, choices.facet_count, choices.weights, settings, seed)
        if self._made_for.get("annealing") == wanted:
            return
        self._made_for["annealing"] = wanted
        request = choices.replaced(method="annealing", settings=settings, seed=seed).coarsening_request
        approximated = (
            tr("the fit at l<sub>max</sub> = {degree}", degree=choices.l_max)
            if fitted
            else tr("the particle")
        )
        self.request.setText(
            tr(
                "{count} planes; target: {imitated}; seed {seed}",
                count=choices.facet_count,
                imitated=approximated,
                seed=seed,
            )
        )
        self.annealing.wait()
        show = self.annealing.show_lesson
        job = Job(trace_annealing, (mesh, request))
        self._context.start(
            tr("Annealing step by step"),
            job,
            show,
            partial=show,
            failed=lambda failure: self.annealing.wait(failure.sentence),
            stopped=self._stopped,
            queue="annealing",
            repeats=True,
        )

    def _stopped(self) -> None:
        self._made_for.pop("annealing", None)
        self.annealing.wait(tr("Stopped. Choose another seed, or come back to this page, to begin again."))

    def _grow(self, entry: ParticleEntry) -> None:
        fit = self._session.results.fit
        if fit is None or self._made_for.get("degrees") == (fit,):
            return
        self._made_for["degrees"] = (fit,)
        self.degrees.show_particle(entry.particle.mesh, rich(entry.id))
        show = self.degrees.show_steps
        job = Job(trace_degrees, (entry.particle.mesh, fit))
        self._context.start(
            tr("Fitting degree by degree"), job, show, partial=show, queue="degrees", repeats=True
        )

    def _show_particles(self) -> None:
        ids = [entry.id for entry in self._session.particles]
        if [self.particle.itemText(place) for place in range(self.particle.count())] != ids:
            self.particle.offer(zip(ids, ids, strict=True))
        self.particle.setValue(self._session.choices.selected)

    def _select(self) -> None:
        if self.particle.currentIndex() >= 0:
            self._session.select(self.particle.value())

    def _turn(self) -> None:
        self._pause()
        self._fill()

    def _control_playback(self, action: Callable[[PlaybackBar], object]) -> None:
        if self.lesson == "field":
            self._context.toast.note(tr("A random field has no steps: drag its bars, or draw again."))
            return
        playback = (self.annealing if self.lesson == "annealing" else self.degrees).playback
        if playback.has_steps:
            action(playback)
        else:
            self._show_absence()

    def _show_absence(self) -> None:
        opened = self._session.selected is not None
        words = tr("The lesson is still being computed.") if opened else tr("Open a particle first.")
        self._context.toast.note(words)

    def _show_font_size(self) -> None:
        """Set the font by a style sheet, because the application's overrides fonts of widgets."""
        size = self._size()
        for part in (self.annealing, self.degrees, self.field, self.tabs.tabBar(), *self._head):
            part.setStyleSheet(f"* {{ font-size: {size:.1f}pt; }}")
        self._shown_size = size
        ensure_polished(self)
        self.set_theme(current_theme())

    def _size(self) -> float:
        """Font size in points; a larger font of the whole window is not enlarged again."""
        return QGuiApplication.font().pointSizeF() * self._magnification() / min(font_share(), FONT_SIZE)

    def _magnification(self) -> float:
        """As chosen, or such that all formulas of a step are seen."""
        low = self.height() < FEW_LINES * self.fontMetrics().height()
        return self._font_scale or (LETTERS_OF_FEW if low else FONT_SIZE)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if self._shown_size not in (0.0, self._size()):
            self._show_font_size()

    def _place(self) -> None:
        titles = (tr("Annealing"), tr("Degrees of the fit"), tr("Random field"))
        for widget, title in zip((self.annealing, self.degrees, self.field), titles, strict=True):
            self.tabs.addTab(widget, title)
        name_tabs(self.tabs)
        head = hbox(self.particle, self.another, (FixedHeightText((self.request,), 1), 1), spacing=10)
        vbox(head, (self.tabs, 1), parent=self, margins=(10, 10, 10, 8))
