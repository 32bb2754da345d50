"""From particle positions to the angle of repose, as section 3.3 describes it.

* :mod:`~regolith_studio.dem.evaluation.settings`: every choice of the procedure.
* :mod:`~regolith_studio.dem.evaluation.profile`: a vertical section and the surface of the pile in it.
* :mod:`~regolith_studio.dem.evaluation.flanks`: the asymmetric and the symmetric triangle.
* :mod:`~regolith_studio.dem.evaluation.section`: both models in one section.
* :mod:`~regolith_studio.dem.evaluation.refusal`: what is no pile, and why.
* :mod:`~regolith_studio.dem.evaluation.interval`: bootstrap over the directions.
"""
