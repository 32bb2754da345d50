"""Long computations as generators that yield events, and the runners that execute them.

* :mod:`~regolith_studio.jobs.events`: the events and :class:`~regolith_studio.jobs.events.Job`.
* :mod:`~regolith_studio.jobs.runners`: inline, thread, process pool, Dask cluster.
* :mod:`~regolith_studio.jobs.executor`: many jobs at the same time.
* one module a kind of work: the jobs themselves.
"""
