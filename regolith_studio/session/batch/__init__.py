"""A recipe worked through particle by particle, with everything on disk at once.

* :mod:`~regolith_studio.session.batch.items`: what a recipe's inputs stand for; nothing is read yet.
* :mod:`~regolith_studio.session.batch.working`: all that is done to one particle, in any process.
* :mod:`~regolith_studio.session.batch.sinks`: the files that the results become, one particle after
  the other.
"""
