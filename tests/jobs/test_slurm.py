"""The script for SLURM in the guide, run with a queue of this machine in place of SLURM's."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from regolith_studio.session.recipe import recipe_of
from regolith_studio.session.run_recipe import run_recipe

pytest.importorskip("distributed")
pytest.importorskip("dask_jobqueue")
pytestmark = [
    pytest.mark.filterwarnings("default"),  # Dask's own
    pytest.mark.skipif(os.name == "nt", reason="job scripts are POSIX"),
]
ROOT = Path(__file__).resolve().parents[2]
SBATCH = """#!/bin/sh
cp "$1" {folder}/job.sh
TMPDIR={folder} setsid bash {folder}/job.sh > {folder}/log 2>&1 &
echo "Submitted batch job $!"
"""
SCANCEL = '#!/bin/sh\nkill -TERM -- "-$1"\n'


def script() -> str:
    """The Python of the guide's paragraph on SLURM."""
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "batch.md").read_text(), flags=re.DOTALL)
    (found,) = [block for block in blocks if "SLURMCluster" in block]
    return found


def here(text: str) -> str:
    """The script for two workers of this machine."""
    smaller = {
        "cores=16": "cores=2",
        "processes=16": "processes=2",
        '"32GiB"': '"4GiB"',
        '"ib0"': '"lo"',
        "jobs=8": "jobs=1",
        '"source ~/regolith/bin/activate"': f'"cd {ROOT}"',
    }
    for before, after in smaller.items():
        assert before in text
        text = text.replace(before, after)
    return text.replace(
        "SLURMCluster(", "SLURMCluster(scheduler_options={'dashboard_address': '127.0.0.1:0'},"
    )


def results(folder: Path) -> dict[str, bytes]:
    files = {path.relative_to(folder): path for path in folder.rglob("*") if path.is_file()}
    return {name.as_posix(): path.read_bytes() for name, path in files.items() if name.parts[0] != "journal"}


@pytest.mark.slow
def test_that_the_script_of_the_guide_brings_workers_that_give_the_same_bytes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tools = tmp_path / "bin"
    tools.mkdir()
    for name, text in (("sbatch", SBATCH), ("scancel", SCANCEL)):
        (tools / name).write_text(text.format(folder=tmp_path) if name == "sbatch" else text)
        (tools / name).chmod(0o755)
    monkeypatch.setenv("PATH", f"{tools}:{os.environ['PATH']}")
    wish = recipe_of(population={"sources": ["ma165"], "n": 6}, target="particle", method="quadric", level=2)
    (tmp_path / "recipe.json").write_text(wish.to_json())
    said: list[str] = []

    def work(_question: str) -> str:
        command = [sys.executable, "-m", "regolith_studio", "run", str(tmp_path / "recipe.json"), "-o"]
        options = [str(tmp_path / "a" / "out"), "--runner", "dask", "--address", said[0]]
        ended = subprocess.run([*command, *options], capture_output=True, text=True, cwd=ROOT, check=False)
        assert ended.returncode == 0, ended.stderr
        assert "2 workers" in ended.stderr
        return ""

    names = {"input": work, "print": said.append}
    exec(compile(here(script()), "docs/batch.md", "exec"), names)
    names["cluster"].close()
    for _ in run_recipe(wish, tmp_path, tmp_path / "b" / "out"):
        pass
    assert results(tmp_path / "a" / "out") == results(tmp_path / "b" / "out")
    told = (tmp_path / "job.sh").read_text()
    for line in (
        "#SBATCH -n 1",
        "#SBATCH --cpus-per-task=2",
        "#SBATCH --mem=4G",
        "--nthreads 1",
        "--nworkers 2",
    ):
        assert line in told
