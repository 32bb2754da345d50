"""From particle positions to the surface of a pile and its slopes, as section 3.3 describes it.

* :mod:`~regolith_studio.dem.evaluation.settings`: parameters and limits; the error of particles
  that form no pile.
* :mod:`~regolith_studio.dem.evaluation.profile`: a vertical section and the surface of the pile in it.
* :mod:`~regolith_studio.dem.evaluation.section`: the asymmetric and the symmetric triangle.
* :mod:`~regolith_studio.dem.evaluation.section`: both models in one section.
"""
