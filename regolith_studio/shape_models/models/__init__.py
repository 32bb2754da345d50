"""The models; each module of this folder that defines ``MODEL`` is one."""

from typing import TYPE_CHECKING

from regolith_studio.registry import Registry

if TYPE_CHECKING:
    from regolith_studio.shape_models.protocol import ShapeModel

DEFAULT_MODEL = "sample_matched"
"""The one that reaches the sampling noise; ``log_field`` is the one to extrapolate with."""


MODELS: "Registry[ShapeModel]" = Registry(__name__, "MODEL", "shape_models", order=lambda model: model.key)
