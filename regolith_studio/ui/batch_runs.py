"""Runs recipes, on this machine or on a cluster, and writes reports, from the window."""

from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QWidget

from regolith_studio.errors import RegolithError
from regolith_studio.io.atomic import write_files
from regolith_studio.jobs.events import Failed, Job
from regolith_studio.messages import N_
from regolith_studio.session.batch_job import run_recipe_job
from regolith_studio.session.preferences import Preferences
from regolith_studio.session.project import SessionRecipe, without_file
from regolith_studio.session.recipe import Recipe, read_recipe
from regolith_studio.session.session import Session
from regolith_studio.ui.dialogs.batch import BatchDialog, BatchRequest, RunDialog
from regolith_studio.ui.translation import tr, translate
from regolith_studio.ui.widgets.toast import Toast

if TYPE_CHECKING:  # what they bring is loaded when it is asked for
    from regolith_studio.session.report.write import WrittenReport
    from regolith_studio.session.run_recipe import RecipeRun
    from regolith_studio.ui.dialogs.batch import ReportDialog, ReportRequest

Dialog = TypeVar("Dialog", bound=RunDialog)


class DialogRuns(QObject, Generic[Dialog]):
    """One run at a time; its dialog can be closed and opened again while it runs.

    - ``session``: whose particles and choices are taken, and who runs it.
    - ``preferences``: what was asked for last, under the name of the queue.
    - ``toast``: says how it ended where the dialog is closed.
    - ``window``: parent of the dialog.
    """

    QUEUE, TITLE = "", ""

    def __init__(self, session: Session, preferences: Preferences, toast: Toast, window: QWidget) -> None:
        super().__init__(window)
        self._session, self._preferences, self._toast, self._window = session, preferences, toast, window
        self._dialog: Dialog | None = None
        self._task = 0

    def ask(self) -> None:
        """Show the dialog: a new one, unless one is open or its run has not ended."""
        if self._dialog is None or not (self._task or self._dialog.isVisible()):
            self._renew()
        assert self._dialog is not None
        self._dialog.show()
        self._dialog.raise_()

    def show_tasks(self) -> None:
        mine = [task for task in self._session.tasks if task.id == self._task]
        if mine and self._dialog is not None:
            self._dialog.show_task(mine[0])

    def make_dialog(self) -> Dialog:
        raise NotImplementedError

    def make_job(self, request: Any) -> Job:
        raise NotImplementedError

    def sentence_of(self, result: Any) -> str:
        raise NotImplementedError

    def stopped_sentence(self) -> str:
        """What is left where it was stopped."""
        raise NotImplementedError

    def _renew(self) -> None:
        if self._dialog is not None:
            self._dialog.close()
            self._dialog.deleteLater()
        self._dialog = self.make_dialog()
        self._dialog.restore_fields(self._preferences.window.get(self.QUEUE, {}))
        self._dialog.started.connect(self._start)
        self._dialog.stopped.connect(lambda: self._session.cancel(self._task))

    def _start(self, request: object) -> None:
        dialog = self._dialog
        assert dialog is not None
        self._preferences.window = self._preferences.window | {self.QUEUE: dialog.field_values()}
        try:
            job = self.make_job(request)
        except RegolithError as error:
            dialog.finish(str(error))
            return
        self._task = self._session.run(
            self.QUEUE,
            self.TITLE,
            job,
            lambda result: self._end(self.sentence_of(result), done=True),
            dialog.show_partial,
            self._failed,
            lambda: self._end(self.stopped_sentence()),
        )
        self.show_tasks()

    def _failed(self, failure: Failed) -> None:
        self._end(translate(failure.sentence))
        self._toast.problem(failure.sentence, failure.details)

    def _end(self, sentence: str, done: bool = False) -> None:
        self._task = 0
        if self._dialog is not None:
            self._dialog.finish(sentence, done)
        if self._dialog is None or not self._dialog.isVisible():
            self._toast.note(sentence)


class BatchRuns(DialogRuns[BatchDialog]):
    """Runs recipes."""

    QUEUE, TITLE = "batch", N_("Running the recipe")

    def make_dialog(self) -> BatchDialog:
        count, unsaved = len(self._session.particles), len(without_file(self._session))
        return BatchDialog(count, unsaved, Path.home() / "regolith-results", self._window)

    def make_job(self, request: BatchRequest) -> Job:
        recipe = self._recipe(request)
        base = request.recipe.parent if request.recipe else Path.cwd()
        return Job(run_recipe_job, (recipe, base, request.folder, request.executor, request.resume))

    def sentence_of(self, result: "RecipeRun") -> str:
        written = tr("Done: {count} files in {folder}.", count=len(result.files), folder=result.folder)
        failed = tr("{count} problems are listed in failed.csv.", count=len(result.problems))
        return " ".join((written, *((failed,) if result.problems else ()), *result.notes[:3]))

    def stopped_sentence(self) -> str:
        return tr("Stopped. Finished parts are kept: run again into the same folder to resume.")

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


class ReportRuns(DialogRuns["ReportDialog"]):
    """Writes the report on the open particles, as the command ``report`` does."""

    QUEUE, TITLE = "report", N_("Making the report")

    def make_dialog(self) -> "ReportDialog":
        from regolith_studio.ui.dialogs.batch import ReportDialog

        session = self._session
        folder = Path.home() / "regolith-report"
        return ReportDialog(len(session.particles), session.choices, folder, self._window)

    def make_job(self, request: "ReportRequest") -> Job:
        from regolith_studio.session.report.write import write_report

        particles = self._session.open_particles
        return Job(write_report, (particles, request.folder, request.settings, request.workers))

    def sentence_of(self, result: "WrittenReport") -> str:
        written = tr("Done: {count} files in {folder}.", count=len(result.files), folder=result.folder)
        return " ".join((written, *map(translate, result.problems)))

    def stopped_sentence(self) -> str:
        return tr("Stopped; nothing was written.")
