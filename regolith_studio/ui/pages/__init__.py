'''The pages of the window; each package of this folder that defines ``PAGE`` is one, and so is each
entry point ``regolith_studio.pages`` of another installed package.

How to add a page
-----------------
Make the package ``ui/pages/<key>/`` and an icon ``resources/icons/<name>.svg``. ``__init__.py`` stays cheap
and announces the page; the widget lives in modules beside it::

    """Page "Grains": what it is for."""

    from regolith_studio.ui.page import ActionSpec, Page

    PAGE = Page(
        key="grains",
        title="Grains",
        icon="sample",
        order=25,
        tip="Count the grains.",
        make="regolith_studio.ui.pages.grains.page:GrainsPage",
        actions=(ActionSpec("count", "&Count", icon="play", shortcut="Ctrl+Return", bar="words"),),
    )

The window finds it by itself; its chapter in ``ui/dialogs/help.py`` and its German texts are added by hand.
and ``page.py``::

    class GrainsPage(PageWidget):
        def __init__(self, context: PageContext) -> None:
            super().__init__()
            self._context = context
            self.plot = CurvePlot("Grain", "Size [µm]", "Press Count.")
            QVBoxLayout(self).addWidget(self.plot)
            context.bindings.refresh("particles", self._show_particles, slow=True)

        def commands(self):
            return {"count": self.count}

        def count(self):
            particles = [entry.particle for entry in self._context.session.particles]
            self._context.start("Counting grains", Job(count_grains, (particles,)), self._show_counts)

What a page can rely on
-----------------------
* It is built at its first visit, in the thread of the window, and kept until the window closes. Its parts are
  made in the constructor or in :meth:`PageWidget.build`; numerical libraries are imported inside jobs.
* **State**: ``context.session`` is the one truth: ``particles``, ``choices``, ``results``,
  ``choose(...)`` and ``dataset_folder`` (written last).
  ``context.commands.adopt(particles, origin)`` opens particles made by a page: they replace or join the open
  ones, as ``context.commands.ask_before_making()`` has answered, and are measured and shown everywhere.
* **Refreshing**: ``context.bindings.refresh("particles choices", action, ("l_max",))`` calls `action` soon
  after these events, and now; after a change of choices only if one of the fields named has changed.
  ``slow=True`` for tables and plots. Nothing is refreshed while the page is hidden;
  what was missed follows at the next visit. What keeps particles says ``keeps_particles=True``, to let go of
  those that have been closed. ``context.bindings.listen(event, action)`` is not held back.
* **Work**: ``context.start(title, job, finished, partial=..., queue=...)`` runs a generator of
  ``Started``, ``Progress`` and ``Partial`` events in a thread; requests are numbered, the newest of a
  queue wins, what an older one says is dropped. Progress, time left and the stop button are in the
  status bar and in the task list by themselves; ``context.session.cancel(number)`` cancels, and
  :class:`~regolith_studio.ui.result_card.RunController` runs one job with its state, time left and
  result on a card. Never compute in a slot for more than 50 ms.
* **Three-dimensional views**: ``make_view(context.views)`` from ``ui.views.image_view``,
  filled by functions of ``scene``; call ``view.release()`` in :meth:`PageWidget.on_close`.
* **Words**: ``context.toast.note("Saved.")``, ``context.toast.problem("One sentence.", details)``.
* **Memory**: ``context.remember(name, value)``, ``context.recall(name, default)`` from one start to the next;
  :meth:`PageWidget.state` and ``restore`` for project files. A splitter made by ``ui.layout`` that has
  an object name is remembered by itself.
* **Files**: a page that names kinds in ``opens=(FileKind.VOLUME,)`` gets dropped and opened files of that
  kind by ``open_path(path)``.
* **Closing**: the window asks when tasks run or when :meth:`PageWidget.busy` says a sentence;
  :meth:`PageWidget.on_close` comes last.
* Widgets, plots and themes: ``ui.widgets`` (``Plot``, ``CurvePlot``, ``BarPlot``, ``HeatTable``,
  ``NumberSlider``, ``SettingsForm``, ``ResultView``, ``labels``), ``ui.theme``, ``ui.layout``. No style
  sheets on single widgets; every control has an accessible name and an object name.
* In tests: ``window.go("grains")`` builds and shows the page and returns its widget.

Pages do not import each other, nor does anything below import a page.
'''

from regolith_studio.registry import Registry
from regolith_studio.ui.page import Page

PAGES: Registry[Page] = Registry(__name__, "PAGE", "pages", order=lambda page: (page.order, page.key))
"""In the order of the sidebar."""
