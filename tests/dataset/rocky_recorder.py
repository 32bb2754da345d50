"""A stand-in for ANSYS Rocky's ``app`` that knows the real method names and notes what is called.

Names, argument names and admitted values are those of the public reference of the scripting
interface (stubs ``ansys.rocky.app`` for 2026 R1; the manual of 2024 R2 has them too).
"""

import inspect
from dataclasses import dataclass, field
from typing import Any


def _signature(**defaults: Any) -> inspect.Signature:
    kinds = inspect.Parameter.POSITIONAL_OR_KEYWORD
    return inspect.Signature(
        [inspect.Parameter(name, kinds, default=value) for name, value in defaults.items()]
    )


NEEDED = inspect.Parameter.empty
NOTHING = _signature()
VALUE = _signature(value=NEEDED)
MEASURE = _signature(value=NEEDED, unit=None)
TRIPLE = _signature(values=NEEDED, unit=None)
WALL_FILE = _signature(custom_filename=NEEDED, import_scale=1.0, convert_yz=False, custom_name_prefix=None)
INLET = _signature(
    particle=None, name=None, mass=100.0, seed_coordinates=None, geometries=None,
    use_geometries_to_compute=False, box_center=None, box_dimensions=None, use_box_center_as_seed_point=False,
)  # fmt: skip
TRANSLATION = _signature(
    start_time=(0.0, "s"), stop_time=(1000.0, "s"), velocity=((0.0, 0.0, 0.0), "m/s"),
    acceleration=((0.0, 0.0, 0.0), "m/s2"), define_as="fixed_velocity",
    final_velocity=((0.0, 0.0, 0.0), "m/s"),
)  # fmt: skip

KNOWN: dict[str, dict[str, tuple[inspect.Signature, str]]] = {
    "app": {"CreateProject": (NOTHING, "project")},
    "project": {
        "SaveProject": (_signature(project_filename=NEEDED), ""),
        "GetStudy": (NOTHING, "study"),
    },
    "study": {
        "GetPhysics": (NOTHING, "physics"),
        "GetMaterialCollection": (NOTHING, "materials"),
        "GetMaterialsInteractionCollection": (NOTHING, "interactions"),
        "CreateParticle": (NOTHING, "particle"),
        "ImportWall": (WALL_FILE, "[wall]"),
        "GetMotionFrameSource": (NOTHING, "frames"),
        "GetDomainSettings": (NOTHING, "domain"),
        "CreateVolumetricInlet": (INLET, "inlet"),
        "GetSolver": (NOTHING, "solver"),
        "StartSimulation": (_signature(skip_summary=False, delete_results=False, non_blocking=False), ""),
    },
    "physics": {
        "SetNormalForceModel": (VALUE, ""),
        "SetTangentialForceModel": (VALUE, ""),
        "SetAdhesionModel": (VALUE, ""),
        "SetRollingResistanceModel": (VALUE, ""),
        "SetEnableCoarseGrainModeling": (VALUE, ""),
        "SetGravityXDirection": (MEASURE, ""),
        "SetGravityYDirection": (MEASURE, ""),
        "SetGravityZDirection": (MEASURE, ""),
    },
    "materials": {"New": (NOTHING, "material")},
    "material": {
        "SetName": (VALUE, ""),
        "SetUseBulkDensity": (VALUE, ""),
        "SetDensity": (MEASURE, ""),
        "SetYoungsModulus": (MEASURE, ""),
        "SetPoissonRatio": (VALUE, ""),
    },
    "interactions": {
        "GetMaterialsInteraction": (_signature(material_1=NEEDED, material_2=NEEDED), "interaction")
    },
    "interaction": {
        "SetStaticFriction": (VALUE, ""),
        "SetDynamicFriction": (VALUE, ""),
        "SetRestitutionCoefficient": (VALUE, ""),
        "SetSurfaceEnergy": (MEASURE, ""),
    },
    "particle": {
        "SetName": (VALUE, ""),
        "SetMaterial": (VALUE, ""),
        "ImportFromSTL": (_signature(stl_filename=NEEDED, as_concave=NEEDED, is_open=False), "true"),
        "EnableRandomOrientation": (NOTHING, ""),
        "GetSizeDistributionList": (NOTHING, "sizes"),
    },
    "sizes": {
        "SetSizeType": (VALUE, ""),
        "SetCgmScaleFactor": (VALUE, ""),
        "Clear": (NOTHING, ""),
        "New": (NOTHING, "size"),
    },
    "size": {"SetSize": (MEASURE, ""), "SetCumulativePercentage": (VALUE, "")},
    "wall": {"SetName": (VALUE, ""), "SetMaterial": (VALUE, "")},
    "frames": {"NewFrame": (NOTHING, "frame")},
    "frame": {
        "SetName": (VALUE, ""),
        "AddTranslationMotion": (TRANSLATION, "motion"),
        "ApplyTo": (_signature(obj=NEEDED), ""),
    },
    "motion": {},
    "inlet": {},
    "domain": {
        "DisableUseBoundaryLimits": (NOTHING, ""),
        "SetCoordinateLimitsMinValues": (TRIPLE, ""),
        "SetCoordinateLimitsMaxValues": (TRIPLE, ""),
    },
    "solver": {"SetSimulationDuration": (MEASURE, "")},
}

ADMITTED = {
    "SetNormalForceModel": {"linear_hysteresis", "linear_elastic_viscous", "damped_hertzian", "custom"},
    "SetTangentialForceModel": {"elastic_coulomb", "coulomb_limit", "mindlin_deresiewicz", "custom"},
    "SetAdhesionModel": {"none", "constant", "linear", "JKR", "custom"},
    "SetRollingResistanceModel": {"type_1", "type_3", "none", "custom"},
    "SetSizeType": {"sieve", "equivalent_diameter", "original_size_scale"},
}


@dataclass
class Recorder:
    """One object of Rocky's; its calls, and the objects that it handed out, in order."""

    kind: str
    calls: list[tuple[str, dict[str, Any]]] = field(default_factory=list)
    children: list["Recorder"] = field(default_factory=list)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        if name not in KNOWN[self.kind]:
            raise AttributeError(f"Rocky's {self.kind} has no method {name}")
        signature, gives = KNOWN[self.kind][name]

        def call(*values: Any, **named: Any) -> Any:
            arguments = dict(signature.bind(*values, **named).arguments)
            if name in ADMITTED and arguments["value"] not in ADMITTED[name]:
                raise ValueError(f"{arguments['value']} is no value of {name}")
            self.calls.append((name, arguments))
            return self._answer(name, gives, arguments)

        return call

    def _answer(self, name: str, gives: str, arguments: dict[str, Any]) -> Any:
        if not gives:
            return None
        if gives == "true":
            return True
        kept = next((child for child in self.children if child.kind == gives), None)
        if name.startswith("Get") and not arguments and kept is not None:
            return kept
        child = Recorder(gives.strip("[]"))
        child.calls.append(("made by " + name, arguments))
        self.children.append(child)
        return [child] if gives.startswith("[") else child

    def of(self, kind: str) -> list["Recorder"]:
        """Every object of a kind below this one."""
        here = [child for child in self.children if child.kind == kind]
        return here + [found for child in self.children for found in child.of(kind)]

    def told(self, name: str) -> Any:
        """Arguments of the only call of a method."""
        (arguments,) = [arguments for called, arguments in self.calls if called == name]
        return next(iter(arguments.values())) if len(arguments) == 1 else tuple(arguments.values())
