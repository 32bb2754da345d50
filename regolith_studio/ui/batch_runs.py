"""Runs recipes from the window, on this machine or on a cluster."""

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QWidget

from regolith_studio.errors import RegolithError
from regolith_studio.io.atomic import write_files
from regolith_studio.jobs.events import Failed, Job
from regolith_studio.messages import N_
from regolith_studio.session.batch_job import ExecutorReady, run_recipe_job
from regolith_studio.session.preferences import Preferences
from regolith_studio.session.project import SessionRecipe, without_file
from regolith_studio.session.recipe import Recipe, read_recipe
from regolith_studio.session.session import Session
from regolith_studio.ui.dialogs.batch import BatchDialog, BatchRequest
from regolith_studio.ui.translation import tr
from regolith_studio.ui.widgets.toast import Toast

if TYPE_CHECKING:  # what it brings is loaded when a batch runs
    from regolith_studio.session.run_recipe import RecipeRun

TITLE = N_("Running the recipe")


class BatchRuns(QObject):
    """One batch at a time; its dialog can be closed and opened again while it runs.

    Parameters
    ----------
    session
        Whose particles and choices make the recipe, and who runs it.
    preferences
        Who worked last.
    toast
        Says how it ended where the dialog is closed.
    window
        Parent of the dialog.
    """

    def __init__(self, session: Session, preferences: Preferences, toast: Toast, window: QWidget) -> None:
        super().__init__(window)
        self._session, self._preferences, self._toast, self._window = session, preferences, toast, window
        self._dialog: BatchDialog | None = None
        self._task = 0

    def ask(self) -> None:
        """Show the dialog: a new one, unless one is open or its batch runs."""
        if self._dialog is None or not (self._task or self._dialog.isVisible()):
            self._renew()
        assert self._dialog is not None
        self._dialog.show()
        self._dialog.raise_()

    def show_tasks(self) -> None:
        """Tell the dialog how far the batch is."""
        mine = [task for task in self._session.tasks if task.id == self._task]
        if mine and self._dialog is not None:
            self._dialog.show_task(mine[0])

    def _renew(self) -> None:
        if self._dialog is not None:
            self._dialog.close()
            self._dialog.deleteLater()
        count, unsaved = len(self._session.particles), len(without_file(self._session))
        self._dialog = BatchDialog(count, unsaved, Path.home() / "regolith-results", self._window)
        self._dialog.restore_fields(self._preferences.window.get("batch", {}))
        self._dialog.started.connect(self._start)
        self._dialog.stopped.connect(lambda: self._session.cancel(self._task))

    def _start(self, request: BatchRequest) -> None:
        dialog = self._dialog
        assert dialog is not None
        self._preferences.window = self._preferences.window | {"batch": dialog.field_values()}
        try:
            recipe = self._recipe(request)
        except RegolithError as error:
            dialog.finish(str(error))
            return
        base = request.recipe.parent if request.recipe else Path.cwd()
        job = Job(run_recipe_job, (recipe, base, request.folder, request.executor, request.resume))
        self._task = self._session.run(
            "batch", TITLE, job, self._done, self._show_executor, self._failed, self._stopped
        )
        self.show_tasks()

    def _recipe(self, request: BatchRequest) -> Recipe:
        if request.recipe:
            return read_recipe(request.recipe)
        dataset_request = self._session.dataset_request
        session_recipe = SessionRecipe.of(
            self._session.particles, self._session.choices, request.outputs, dataset_request
        )
        path = (request.folder / "drawn.json").absolute()
        recipe, models = session_recipe.files_for(path, absolute_path=True)
        write_files(models)
        return recipe

    def _show_executor(self, value: object) -> None:
        if isinstance(value, ExecutorReady) and self._dialog is not None:
            self._dialog.show_executor(value)

    def _done(self, done: "RecipeRun") -> None:
        written = tr("Done: {count} files in {folder}.", count=len(done.files), folder=done.folder)
        failed = tr("{count} problems are listed in failed.csv.", count=len(done.problems))
        self._end(" ".join((written, *((failed,) if done.problems else ()))), report=True)

    def _failed(self, failure: Failed) -> None:
        self._end(failure.sentence)
        self._toast.problem(failure.sentence, failure.details)

    def _stopped(self) -> None:
        self._end(tr("Stopped. Finished parts are kept: run again into the same folder to resume."))

    def _end(self, sentence: str, report: bool = False) -> None:
        self._task = 0
        if self._dialog is not None:
            self._dialog.finish(sentence, report)
        if self._dialog is None or not self._dialog.isVisible():
            self._toast.note(sentence)
