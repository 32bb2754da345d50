"""Long lines of an engine's certificate, piece by piece: docs/repose_engines.md.

    python -m benchmarks.certificate_lines ENGINE PIECES.json LINE...

Lines are loose_dice, tapped_dice, half_step and gravity, whose pieces are a kind of dice or a seed of heaps.
PIECES keeps what is measured: a program that was stopped goes on with the next piece. A complete line takes
its place in ``benchmarks/results/engine_certificates.json``; its seconds are processor time.
"""

import json
import sys
import time
from collections.abc import Callable, Generator, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from regolith_studio.dem.verification import MeasuredLine, VerifiableEngine
from regolith_studio.dem.verification.certificate import (
    MEASUREMENTS,
    Certificate,
    certificate_document,
    verifiable_engine,
)
from regolith_studio.dem.verification.heaps import (
    DICE,
    SEEDS,
    angle_on_moon,
    dice_fraction,
    dice_line,
    paired_line,
    platonic_solids,
    step_pair,
)
from regolith_studio.resources import results_folder
from regolith_studio.steps import result_of

Pieces = dict[str, dict[str, dict[str, Any]]]
"""By line and piece: the value and the seconds of processor time."""


def main(key: str, place: Path, lines: list[str]) -> None:
    """Measure the pieces that are missing, and print and store each line when it is complete."""
    engine = verifiable_engine(key)
    pieces: Pieces = json.loads(place.read_text(encoding="utf-8")) if place.exists() else {}
    for line in lines:
        known = pieces.setdefault(line, {})
        for name, measure in measurements(line, engine, pieces).items():
            if name not in known:
                begun = time.process_time()
                known[name] = {"value": result_of(measure()), "seconds": time.process_time() - begun}
                place.write_text(json.dumps(pieces, indent=1) + "\n", encoding="utf-8")
                print(line, name, known[name], flush=True)
        store(engine, complete_line(line, pieces))


def measurements(
    line: str, engine: VerifiableEngine, pieces: Pieces
) -> Mapping[str, Callable[[], Generator[None, None, Any]]]:
    """What measures each piece of a line."""
    if line in DICE:
        taps = DICE[line][1]
        solids = platonic_solids()
        return {name: partial(dice_fraction, engine, solids[name], taps) for name in solids}
    measure = {"half_step": step_pair, "gravity": angle_on_moon}[line]
    if line == "gravity" and len(pieces.get("half_step", {})) < len(SEEDS):
        raise SystemExit("The heaps on the Earth are those of half_step: name that line before gravity.")
    return {str(seed): partial(measure, engine, seed) for seed in SEEDS}


def complete_line(line: str, pieces: Pieces) -> MeasuredLine:
    """The line of all of its pieces."""
    values = {name: piece["value"] for name, piece in pieces[line].items()}
    seconds = sum(piece["seconds"] for piece in pieces[line].values())
    if line in DICE:
        return replace(dice_line(line, values), seconds=seconds)
    if line == "gravity":
        values = {seed: (pieces["half_step"][seed]["value"][0], angle) for seed, angle in values.items()}
    return replace(paired_line(line, list(values.values())), seconds=seconds)


def store(engine: VerifiableEngine, line: MeasuredLine) -> None:
    """Put a line into the certificate of the engine, which must be of the installed version."""
    path = results_folder() / "engine_certificates.json"
    certificates = json.loads(path.read_text(encoding="utf-8"))
    version = engine.find().version
    if (earlier := certificates[engine.key])["version"] != version:
        raise SystemExit(
            f"The certificate is of version {earlier['version']}, not {version}: verify the engine."
        )
    lines = {each["key"]: MeasuredLine(**each) for each in earlier["lines"]} | {line.key: line}
    ordered = tuple(lines[key] for key in MEASUREMENTS if key in lines)
    left_out = tuple(key for key in MEASUREMENTS if key not in lines)
    certificates[engine.key] = certificate_document(Certificate(engine.key, version, ordered, left_out))
    path.write_text(json.dumps(certificates, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    print(line)


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), sys.argv[3:])
