"""Builds the lifting-cylinder test of a dataset in ANSYS Rocky (2024 R2 to 2026 R1).

Written by Regolith Studio; all numbers are in case.json beside this file, in SI units.

Inside Rocky: Tools > Script Editor > open this file > Run (set FOLDER first if it is not found).
From outside:  python rocky_case.py            (needs the package ansys-rocky-core and a licence)

Nothing is simulated before you say so: the project is built and saved; start it in Rocky, or set
START = True.
"""

import json
from pathlib import Path

FOLDER = None
"""The folder of case.json; found by itself where the script knows its own place."""
START = False
"""Whether the simulation is started at once."""
NARROW = False
"""Set True if your Rocky draws sizes between the rows of its table: every row is then followed by one a
ten-thousandth below, so that only the diameters of the dataset come out."""


def main(application):
    """Build, save and (if wanted) start the case; `application` is Rocky's ``app``."""
    folder = _folder()
    case = json.loads((folder / "case.json").read_text(encoding="utf-8"))
    project = application.CreateProject()
    project.SaveProject(str(folder / case["project"]))
    study = project.GetStudy()
    set_physics(study.GetPhysics(), case)
    set_materials(study, case)
    particles = [(make_particle(study, folder, case, record), record) for record in case["particles"]]
    make_walls(study, folder, case)
    for particle, record in particles:
        make_inlet(study, particle, record, case)
    set_solver(study, case)
    project.SaveProject(str(folder / case["project"]))
    if START:
        study.StartSimulation()
    return study


def set_physics(physics, case):
    """Hertz, Mindlin-Deresiewicz, JKR; gravity along -z; coarse graining."""
    physics.SetNormalForceModel("damped_hertzian")
    physics.SetTangentialForceModel("mindlin_deresiewicz")
    physics.SetAdhesionModel("JKR")
    physics.SetRollingResistanceModel("none")
    physics.SetEnableCoarseGrainModeling(case["coarse_graining_factor"] != 1.0)
    physics.SetGravityXDirection(0.0, "m/s2")
    physics.SetGravityYDirection(0.0, "m/s2")
    physics.SetGravityZDirection(-case["test"]["gravity"], "m/s2")


def set_materials(study, case):
    """One material for particles, tube and plate each, and how they meet."""
    contact, test, materials = case["contact"], case["test"], study.GetMaterialCollection()
    for name in ("regolith", "tube", "plate"):
        material = materials.New()
        material.SetName(name)
        material.SetUseBulkDensity(False)
        material.SetDensity(contact["density"], "kg/m3")
        material.SetYoungsModulus(contact["youngs_modulus"], "N/m2")
        material.SetPoissonRatio(contact["poissons_ratio"])
    pairs = study.GetMaterialsInteractionCollection()
    for other, static, dynamic in (
        ("regolith", contact["static_friction"], contact["dynamic_friction"]),
        ("tube", test["wall_friction"], test["wall_friction"]),
        ("plate", test["plate_friction"], test["plate_friction"]),
    ):
        pair = pairs.GetMaterialsInteraction("regolith", other)
        pair.SetStaticFriction(static)
        pair.SetDynamicFriction(dynamic)
        pair.SetRestitutionCoefficient(contact["restitution"])
        pair.SetSurfaceEnergy(contact["surface_energy"], "J/m2")


def make_particle(study, folder, case, record):
    """A shape with its sizes; sizes are equivalent diameters, percentages are by mass."""
    particle = study.CreateParticle()
    particle.SetName(record["key"])
    particle.SetMaterial("regolith")
    mesh = str(folder / record["mesh"])
    if not particle.ImportFromSTL(mesh, record["concave"]):
        raise RuntimeError("Rocky could not import " + mesh)
    particle.EnableRandomOrientation()
    sizes = particle.GetSizeDistributionList()
    sizes.SetSizeType("equivalent_diameter")
    if case["coarse_graining_factor"] != 1.0:
        sizes.SetCgmScaleFactor(case["coarse_graining_factor"])
    sizes.Clear()
    for diameter, percent in size_rows(record["sizes"]):
        entry = sizes.New()
        entry.SetSize(diameter, "m")
        entry.SetCumulativePercentage(percent)
    return particle


def size_rows(sizes):
    """Diameters in metres, descending, each with the cumulative percentage by mass up to it."""
    below = [percent for _, percent in sizes[1:]] + [0.0]
    for (diameter, percent), lower in zip(sizes, below):  # noqa: B905  Rocky's Python may be older
        yield diameter, percent
        if NARROW:
            yield diameter * (1 - 1e-4), lower


def make_walls(study, folder, case):
    """A plate that stays and a tube that is lifted when the particles have settled."""
    walls = {}
    for name in ("plate", "tube"):
        walls[name] = study.ImportWall(str(folder / "walls" / (name + ".stl")), 1.0, False)[0]
        walls[name].SetName(name)
        walls[name].SetMaterial(name)
    test, settled = case["test"], case["times"]["settling_time"]
    frame = study.GetMotionFrameSource().NewFrame()
    frame.SetName("lift")
    frame.AddTranslationMotion(
        start_time=(settled, "s"),
        stop_time=(settled + test["height"] / test["lift_speed"], "s"),
        velocity=((0.0, 0.0, test["lift_speed"]), "m/s"),
    )
    frame.ApplyTo(walls["tube"])
    domain = study.GetDomainSettings()
    domain.DisableUseBoundaryLimits()
    domain.SetCoordinateLimitsMinValues(case["domain"][0], "m")
    domain.SetCoordinateLimitsMaxValues(case["domain"][1], "m")


def make_inlet(study, particle, record, case):
    """Fill the tube with this class's share of the mass."""
    box = case["filling_box"]
    return study.CreateVolumetricInlet(
        particle,
        name="fill " + record["key"],
        mass=record["mass"],
        seed_coordinates=tuple(box["seed"]),
        box_center=tuple(box["center"]),
        box_dimensions=tuple(box["dimensions"]),
    )


def set_solver(study, case):
    """Settle, lift, come to rest."""
    study.GetSolver().SetSimulationDuration(case["duration"], unit="s")


def _folder():
    if FOLDER:
        return Path(FOLDER).resolve()
    try:
        return Path(__file__).resolve().parent
    except NameError:
        return Path.cwd()


def _application():
    """Rocky's ``app``: given inside Rocky, launched from outside."""
    if "app" in globals():
        return globals()["app"]
    import ansys.rocky.core as pyrocky

    return pyrocky.launch_rocky().api


if __name__ == "__main__" or "app" in globals():
    main(_application())
