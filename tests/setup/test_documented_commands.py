"""Every command of the guide runs, page by page, on small files under the names of the page."""

import shutil
import zipfile
from pathlib import Path

import h5py
import numpy as np
import pytest
import tifffile

from regolith_studio.cli.entry import run
from regolith_studio.harmonics.fit import fit_harmonics
from regolith_studio.readers.particles import read_mesh

from .test_documented_code import ROOT, SHORT, commands, table

ELSEWHERE = {
    "serve": "does not end; tests/web starts it",
    "repose": "heaps of minutes; tests/dem and tests/scene have smaller ones",
    "uncertainty": "20 grains and their heaps; tests/jobs/test_uncertainty.py has smaller ones",
    "classify": "needs a painted scan; tests/cli/test_classify.py has one",
}
"""First words of commands that run in other tests."""
ELSEWHERE_PAGES = ("plugins.md", "classifiers.md", *SHORT)
"""Pages whose commands need plug-ins or painted scans, or run in test_documented_code.py."""


def is_run(words: list[str]) -> bool:
    """Whether a command is run here; tests/jobs/test_dask_cluster.py has those of a cluster."""
    return words[0] not in ELSEWHERE and "--address" not in words


PAGES = sorted({page for page, words in commands() if is_run(words)} - set(ELSEWHERE_PAGES))
NAMES = {
    "MESHES": "grains",
    "MESH": "grain.stl",
    "SAMPLE": "grains",
    "FOLDER": ".",
    "particle.stl": "grain.stl",
    "stones/": "grains",
    "grains/*.anm": "grain.anm",
    "basalt,glass": "basalt",
    "512,512,600": "64,64,64",
    "resources/samples/ct/synthetic-grey.tif": str(ROOT / "resources/samples/ct/synthetic-grey.tif"),
} | {f"{name}.txm": f"{name}.tif" for name in ("scan", "a", "b", "c")}
"""Words of the pages, and what stands for them here."""
FEWER = {"-n": "8", "--particles": "400", "--representatives": "3"}
"""Numbers of options that would take minutes."""
MORE = {
    "report": ["--heap", "0", "--study-particles", "3", "--splits", "1", "--drawn", "1"],
    "study population": ["--splits", "1"],
}
"""Options that make a command quick."""
CROWD = ("report", "study population")
"""Commands that want 20 particles."""
SAMPLES = ("grains", "grains/", "sample", "sample.json")
"""What they are given on the pages."""
FIRST = {
    "exporters.md": "dataset build grains -o SET",
    "segmentation.md": "extract scan.tif -o balls --labels labels.nrrd",
}
"""What a page takes for granted."""


def balls() -> np.ndarray:
    """Two balls of 20 voxels, slices first."""
    z, y, x = np.mgrid[:64, :64, :64]
    distance = np.minimum(*(np.hypot(x - at, np.hypot(y - at, z - at)) for at in (25, 50)))
    noise = np.random.default_rng(0).integers(0, 20, distance.shape)
    return (np.where(distance < 10, 180, 40) + noise).astype(np.uint8)


def write_scans(folder: Path) -> None:
    """Scans of balls, whose voxels have 50 micrometres where the file can say so."""
    metadata = {"axes": "ZYX", "unit": "um", "spacing": 50.0}
    (folder / "simulants").mkdir()
    for name in ("scan", "a", "b", "c", "simulants/a", "simulants/b"):
        path, pixel = folder / f"{name}.tif", (1 / 50, 1 / 50)
        tifffile.imwrite(path, balls(), imagej=True, resolution=pixel, metadata=metadata)
    (folder / "scans.csv").write_text("scan,h-maxima\nsimulants/a.tif,1.2\nsimulants/b.tif,\n")
    (folder / "scan.raw").write_bytes(balls().astype("<u2").tobytes())
    with h5py.File(folder / "scan.h5", "w") as file:
        file["exported_data"] = balls()


def write_materials() -> None:
    """Archives of meshes in two fractions, and tables of length, width and thickness."""
    for name in ("JSC-1A", "NU-LHT", "soil"):
        with zipfile.ZipFile(f"{name}.zip", "w") as archive:
            for mesh in sorted(Path("crowd").glob("*.stl")):
                for fraction in ("75m", "75-300"):
                    archive.write(mesh, f"{fraction}/{mesh.name}")
    rng = np.random.default_rng(0)
    for name, size in (("75m", 50.0), ("75-300", 150.0)):
        rows = -np.sort(-size * rng.uniform(0.5, 1.0, (30, 3)), axis=1)
        lines = ("{:.2f},{:.2f},{:.2f}".format(*row) for row in rows)
        Path(f"{name}.csv").write_text("\n".join(["Length (um),Width (um),Thickness (um)", *lines]) + "\n")


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The files that the pages speak of."""
    monkeypatch.chdir(tmp_path)
    for folder, count in (("grains", 4), ("crowd", 21)):
        assert run(["generate", "ma165", "-n", str(count), "-o", folder, "--level", "3", "--seed", "1"]) == 0
    first = min(tmp_path.glob("grains/*.stl"))
    shutil.copy(first, "grain.stl")
    coefficients = fit_harmonics(read_mesh(first, unit="um").mesh, l_max=4).coefficients
    Path("grain.anm").write_text(table(coefficients.values))
    write_scans(tmp_path)
    write_materials()
    return tmp_path


def adapted(words: list[str]) -> list[str]:
    """A command of a page on the files of :func:`here`, made quick."""
    done = [NAMES.get(word, word) for word in words]
    said = " ".join(done)
    if said.startswith(CROWD):
        done = ["crowd" if word in SAMPLES else word for word in done]
    for option, number in FEWER.items():
        if option in done:
            done[done.index(option) + 1] = number
    return done + next((more for key, more in MORE.items() if said.startswith(key)), [])


@pytest.mark.slow
@pytest.mark.timeout(1200)
@pytest.mark.parametrize("page", PAGES)
@pytest.mark.usefixtures("here")
def test_that_the_commands_of_a_page_run_one_after_the_other(
    page: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(FIRST.get(page, "check").split()) == 0
    for words in (adapted(words) for name, words in commands() if name == page and is_run(words)):
        if words[0] == "extract":  # the grains of the other commands stay
            words[words.index("-o") + 1] += "-of-scan"
        assert run(words) == 0, (words, capsys.readouterr().err)
