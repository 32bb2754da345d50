"""Running a recipe particle by particle; each result is written to disk when it is done.

* :mod:`~regolith_studio.session.batch.inputs`: the particles of a recipe before they are read.
* :mod:`~regolith_studio.session.batch.preprocessing`: grains of volumes and fitted models.
* :mod:`~regolith_studio.session.batch.particle_task`: all that is done to one particle, in any process.
* :mod:`~regolith_studio.session.batch.writers`: the files that the results become.
* :mod:`~regolith_studio.session.batch.writers`: the dataset and its exports.
"""
