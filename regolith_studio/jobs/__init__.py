"""Long work as generators that tell their story, and the runners that listen to it.

* :mod:`~regolith_studio.jobs.events`: what a job can say, and :class:`~regolith_studio.jobs.events.Job`.
* :mod:`~regolith_studio.jobs.runners`: inline, thread (one lane an item on screen), process pool.
* one module a kind of work: the jobs themselves.
"""
