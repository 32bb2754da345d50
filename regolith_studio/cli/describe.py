"""``describe``: descriptors and health of meshes."""

import typer

from regolith_studio.cli.options import Jobs, Json, Meshes, Seed, Unit


def describe(meshes: Meshes, unit: Unit = "um", json: Json = False, jobs: Jobs = 1, seed: Seed = 0) -> None:
    """Measure meshes: volume, area, sphericity, diameters ..., and what is wrong with them."""
    from regolith_studio.cli.inputs import exit_code, read_inputs, start_reader

    start_reader()
    from regolith_studio.cli.terminal import complain, follow, print_json, print_table
    from regolith_studio.jobs.examining import examine_sample
    from regolith_studio.session.outputs.descriptors import described, short_table

    del seed  # taken by every command; nothing here is random
    loaded = read_inputs(meshes, unit)
    facts = follow(examine_sample(loaded.particles, workers=jobs))
    if json:
        print_json([described(p, each) for p, each in zip(loaded.particles, facts, strict=True)])
    else:
        print_table(short_table(loaded.particles, facts))
        for particle, each in zip(loaded.particles, facts, strict=True):
            complain(f"{particle.name}: {note}" for note in (*particle.notes, each.problem) if note)
    raise typer.Exit(exit_code(meshes, loaded, sum(bool(each.problem) for each in facts)))
