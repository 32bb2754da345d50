"""The session of a user without any window: choices, results, jobs, recipes and projects.

The cycle
---------
``Session(runner)`` holds three things: ``particles`` (tuple of
:class:`~regolith_studio.session.results.ParticleEntry`), ``choices`` (a frozen
:class:`~regolith_studio.session.choices.Choices`) and ``results`` (a frozen
:class:`~regolith_studio.session.results.Results`). A panel reads these, connects to
``session.events.<name>`` and calls:

=============================================  ==================================================
``open(paths, unit=None, add=False)``          read meshes in the background
``open_sample()``                              the shipped particles
``select(id)``                                 put a particle on screen
``choose("slider", l_max=7)``                  change choices; the first word joins the changes of
                                               one drag to one undo step, until ``end_step()``
``undo()``, ``redo()``, ``can_undo``, ...      steps of choices
``start_study("lmax_study")``                  or ``"coarsening_study"``: over all open particles
``tasks``, ``cancel(task.id)``, ``close()``    what is running
=============================================  ==================================================

Bad values raise :class:`~regolith_studio.errors.InputError` with one sentence; everything that goes
wrong in the background arrives at ``events.failed`` as a ``Failure(title, sentence, details)``.

The events are those of :class:`~regolith_studio.session.results.SessionEvents`, emitted in the thread that
owns the session; ``choices`` carries the names of the fields that have changed.

Which work a change of choices makes necessary is decided by the pure function
:func:`~regolith_studio.session.choices.plan`; requests are numbered and answers to old ones dropped.

The runner of a window::

    runner = ThreadRunner(post)      # post(function): call it soon, in order, in the UI thread
    session = Session(runner)

``post`` is called from worker threads; with Qt, emit a queued ``Signal(object)`` whose slot calls
its argument. ``InlineRunner()`` runs everything at once, for tests.
"""
