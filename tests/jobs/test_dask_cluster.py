"""A Dask cluster gives the same bytes, encrypted or not, whoever of it dies; its processes are real."""

import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile

import pytest

from regolith_studio.errors import InputError, MissingRequirement
from regolith_studio.geometry.mesh import Mesh
from regolith_studio.geometry.sphere_points import icosphere
from regolith_studio.imaging import volume_slabs
from regolith_studio.imaging.volume import sample_file
from regolith_studio.io.triangles import stl_bytes
from regolith_studio.jobs.events import Finished, Job, Progress
from regolith_studio.jobs.executor import Executor
from regolith_studio.jobs.extraction_jobs import extract_measured
from regolith_studio.jobs.extraction_settings import GrainSettings, VolumeInput
from regolith_studio.jobs.runners import dask_cluster
from regolith_studio.jobs.runners.dask_cluster import TlsFiles
from regolith_studio.session.recipe import Recipe, recipe_of
from regolith_studio.session.run_recipe import run_recipe
from tests.files import contents
from tests.jobs.small_jobs import name_and_numbers, square, throttle

pytest.importorskip("distributed")
pytestmark = pytest.mark.filterwarnings("default")  # Dask's own
ROOT = Path(__file__).resolve().parents[2]


def small_recipe(n: int = 12) -> Recipe:
    return recipe_of(
        inputs=[],
        population={"sources": ["ma165"], "n": n, "l_max": 5},
        target="particle",
        method="quadric",
        level=2,
        n_facets=12,
    )


def done(folder: Path, executor: Executor | int, n: int = 12) -> dict[str, bytes]:
    for _ in run_recipe(small_recipe(n), folder.parent, folder, executor, chunk=2):
        pass
    return contents(folder)


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def program(name: str, *options: object) -> "subprocess.Popen[bytes]":
    command = [sys.executable, "-m", f"distributed.cli.dask_{name}", *map(str, options)]
    return subprocess.Popen(
        command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
    )


def wait_for(port: int, seconds: float = 60.0) -> None:
    """Until somebody listens: a scheduler takes seconds to load where others are at work."""
    end = time.monotonic() + seconds
    while True:
        try:
            socket.create_connection(("127.0.0.1", port), 1.0).close()
        except ConnectionRefusedError:
            assert time.monotonic() < end, f"nobody listens on port {port}"
            time.sleep(0.1)
        else:
            return


@dataclass(frozen=True)
class Cluster:
    """A scheduler and two workers on this machine."""

    address: str
    scheduler: "subprocess.Popen[bytes]"
    workers: tuple["subprocess.Popen[bytes]", ...]


@contextmanager
def cluster(scheme: str = "tcp", *tls: object) -> Iterator[Cluster]:
    address = f"{scheme}://127.0.0.1:{free_port()}"
    place = ["--host", f"{scheme}://127.0.0.1", "--port", address.rpartition(":")[2]]
    scheduler = program("scheduler", *place, "--no-dashboard", *tls)
    options = ("--nthreads", 1, "--no-nanny", "--no-dashboard")
    workers = tuple(program("worker", address, *options, *tls) for _ in range(2))
    try:
        wait_for(int(place[-1]))
        yield Cluster(address, scheduler, workers)
    finally:
        for process in (scheduler, *workers):
            process.kill()
            process.wait()


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    return done(tmp_path_factory.mktemp("alone") / "out", 1)


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="signals are a matter of POSIX")
def test_that_a_cluster_that_loses_a_worker_ends_with_the_same_bytes(
    tmp_path: Path, alone: dict[str, bytes]
) -> None:
    with cluster() as there, closing(Executor.on_cluster(there.address)) as executor:
        executor._runner._client.wait_for_workers(2, timeout=60)  # type: ignore[union-attr]
        killed = False
        for step in run_recipe(small_recipe(), tmp_path, tmp_path / "out", executor, chunk=2):
            if isinstance(step, Progress) and step.done >= 2 and not killed:
                there.workers[0].send_signal(signal.SIGKILL)
                killed = True
    assert killed
    assert contents(tmp_path / "out") == alone


@pytest.mark.slow
def test_that_a_cluster_that_goes_away_is_one_sentence_and_the_run_can_go_on(
    tmp_path: Path, alone: dict[str, bytes]
) -> None:
    with cluster() as there, closing(Executor.on_cluster(there.address)) as executor:
        steps = run_recipe(small_recipe(), tmp_path, tmp_path / "out", executor, chunk=2)
        with pytest.raises(MissingRequirement, match="--resume"):  # noqa: PT012
            for step in steps:
                if isinstance(step, Progress) and step.done >= 4:
                    there.scheduler.kill()
    for _ in run_recipe(small_recipe(), tmp_path, tmp_path / "out", resume=True):
        pass
    assert contents(tmp_path / "out") == alone


def signed(folder: Path, name: str) -> None:
    """An authority in ``ca.pem``, and a certificate of its own making in ``cert.pem`` with ``key.pem``."""
    names = {path: str(folder / path) for path in ("ca.key", "ca.pem", "key.pem", "cert.csr", "cert.pem")}
    fresh = ["req", "-newkey", "rsa:2048", "-nodes", "-subj"]
    authority = [*fresh, "/CN=authority", "-x509", "-days", "2", "-keyout", names["ca.key"], "-out"]
    request = [*fresh, f"/CN={name}", "-keyout", names["key.pem"], "-out", names["cert.csr"]]
    sign = ["x509", "-req", "-days", "2", "-CAcreateserial", "-in", names["cert.csr"], "-CA", names["ca.pem"]]
    for command in (
        [*authority, names["ca.pem"]],
        request,
        [*sign, "-CAkey", names["ca.key"], "-out", names["cert.pem"]],
    ):
        subprocess.run(["openssl", *command], check=True, capture_output=True)


@pytest.mark.slow
@pytest.mark.skipif(not shutil.which("openssl"), reason="openssl makes the certificates")
def test_that_an_encrypted_cluster_works_and_lets_no_stranger_in(
    tmp_path: Path, alone: dict[str, bytes]
) -> None:
    (tmp_path / "tls").mkdir()
    (tmp_path / "other").mkdir()
    for folder in ("tls", "other"):
        signed(tmp_path / folder, "regolith")
    files, strangers = (
        TlsFiles(tmp_path / folder / "ca.pem", tmp_path / folder / "cert.pem", tmp_path / folder / "key.pem")
        for folder in ("tls", "other")
    )
    options = ("--tls-ca-file", files.authority, "--tls-cert", files.certificate, "--tls-key", files.key)
    with cluster("tls", *options) as there:
        with closing(Executor.on_cluster(there.address, tls=files)) as executor:
            assert done(tmp_path / "out", executor) == alone
        with pytest.raises(MissingRequirement, match="No cluster answers"):
            dask_cluster.DaskRunner(there.address, tls=strangers)


def grains(
    given: VolumeInput, executor: Executor, scratch: Path, after: Callable[[int], None] = lambda _: None
) -> list[tuple[str, str, object]]:
    """Names, meshes and descriptors of a scan's particles; `after` gets the number of each step."""
    found: list[tuple[str, str, object]] = []
    steps = extract_measured(given, GrainSettings(), scratch, name_and_numbers, found.append, executor)
    for number, _ in enumerate(steps):
        after(number)
    return found


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="signals are a matter of POSIX")
def test_that_a_cluster_finds_the_grains_that_one_process_finds_also_when_a_worker_is_killed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Slabs of eight slices, so that every stage has several tasks; the first worker dies in the middle."""
    given = VolumeInput(sample_file("grey"), kind="grey")
    alone = grains(given, Executor(1), tmp_path)
    assert len(alone) == 46
    monkeypatch.setattr(volume_slabs.slab_ranges, "__defaults__", (1,))
    monkeypatch.setattr(volume_slabs, "BATCH_VOXELS", 1)
    with cluster() as there, closing(Executor.on_cluster(there.address)) as executor:
        executor._runner._client.wait_for_workers(2, timeout=60)  # type: ignore[union-attr]
        total: list[int] = []
        assert grains(given, executor, tmp_path, total.append) == alone

        def kill(number: int) -> None:
            if number == len(total) // 2:
                there.workers[0].send_signal(signal.SIGKILL)

        assert grains(given, executor, tmp_path, kill) == alone
    assert there.workers[0].returncode == -signal.SIGKILL
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_that_workers_that_do_not_see_the_volume_or_the_output_are_one_sentence(tmp_path: Path) -> None:
    shutil.copy(sample_file("grey"), tmp_path / "scan.tif")
    given = VolumeInput(tmp_path / "scan.tif", kind="grey")
    (tmp_path / "out").mkdir()
    with closing(Executor.on_cluster(workers=1)) as executor:
        client = executor._runner._client  # type: ignore[union-attr]
        seen = dask_cluster._size_and_text(str(given.path), "")

        def elsewhere(answer: object) -> None:
            client.run = lambda *_: {"tcp://10.0.0.2:4001": answer}

        elsewhere((None, ""))
        with pytest.raises(MissingRequirement, match=r"4001 does not find .*scan\.tif"):
            grains(given, executor, tmp_path / "out")
        elsewhere(seen)
        with pytest.raises(MissingRequirement, match=r"4001 does not see the folder .*out"):
            grains(given, executor, tmp_path / "out")
    assert not list((tmp_path / "out").iterdir())


@pytest.mark.slow
def test_that_a_cluster_of_this_machine_gives_the_same_bytes(tmp_path: Path, alone: dict[str, bytes]) -> None:
    library = archive(tmp_path / "JSC.zip")
    options = {"target": "particle", "method": "quadric", "n_facets": 12}
    outputs = {"dataset_by_group": True, "meshes": False, "summary": False}
    recipe = recipe_of(inputs=[str(library)], population=None, outputs=outputs, **options)

    def dataset(place: str, executor: Executor | int) -> dict[str, bytes]:
        for _ in run_recipe(recipe, tmp_path, tmp_path / place / "out", executor, chunk=2):
            pass
        return contents(tmp_path / place / "out")

    with closing(Executor.on_cluster(workers=2)) as executor:
        assert executor.workers == 2
        assert executor.dashboard.startswith("http://127.0.0.1:")
        assert done(tmp_path / "out", executor) == alone
        assert dataset("cluster", executor) == (made := dataset("alone", 1))
        assert {"dataset/75m/dataset.json", "dataset/300p/dataset.json", "failed.csv"} <= made.keys()
        client = executor._runner._client  # type: ignore[union-attr]
        client.run = lambda *_: {"tcp://10.0.0.2:4001": (None, "")}
        with pytest.raises(MissingRequirement, match=r"4001 does not find .*JSC\.zip"):
            dataset("elsewhere", executor)


def archive(path: Path) -> Path:
    """Two fractions, one of them an archive, of three ellipsoids each, and a member that is damaged."""
    sphere = icosphere(2)
    with ZipFile(path, "w") as library, ZipFile(path.with_name("300p.zip"), "w", ZIP_DEFLATED) as inner:
        for number, axes in enumerate([(3.0, 2.0, 1.5), (2.0, 2.0, 1.0), (4.0, 3.0, 2.0)]):
            stl = stl_bytes(Mesh(sphere.vertices * axes, sphere.faces).triangles, "test")
            library.writestr(f"75m/p{number}.stl", stl)
            inner.writestr(f"p{number}.stl", stl)
        inner.close()
        library.writestr("75m/p3.stl", stl[:200])
        library.write(path.with_name("300p.zip"), "300p.zip")
    return path


@pytest.mark.slow
def test_that_a_job_of_a_cluster_that_is_cancelled_stops_between_two_steps(tmp_path: Path) -> None:
    file = tmp_path / "beat"
    with closing(Executor.on_cluster(workers=1)) as executor:
        answers = executor.as_completed([Job(throttle, (str(file),))])
        while not file.exists():
            next(answers)
        answers.close()
        time.sleep(2.0)
        last = file.read_text()
        time.sleep(1.0)
        assert file.read_text() == last
        [found] = [each for each in executor.results([Job(square, (3,))]) if each is not None]
        assert found == Finished(9)


DYING = """
import os, signal
from regolith_studio.jobs.events import Job
from regolith_studio.jobs.executor import Executor
from tests.jobs.small_jobs import process_id

if __name__ == "__main__":
    executor = Executor.on_cluster(workers=1)
    (first,) = (each for each in executor.results([Job(process_id)]) if each is not None)
    os.kill(first.value, signal.SIGKILL)
    (second,) = (each for each in executor.results([Job(process_id)]) if each is not None)
    print(second.value not in (first.value, os.getpid()))
    executor.close()
"""


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="signals are a matter of POSIX")
def test_that_a_worker_of_this_machine_that_dies_is_replaced_without_a_line_of_dask() -> None:
    done = subprocess.run(
        [sys.executable, "-c", DYING], cwd=ROOT, capture_output=True, text=True, timeout=150
    )
    assert (done.stdout, done.stderr) == ("True\n", "")


def test_that_an_encrypted_address_needs_files_that_are_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="encrypted"):
        dask_cluster.DaskRunner("tls://127.0.0.1:8786")
    with pytest.raises(InputError, match=r"ca\.pem is not there"):
        dask_cluster.DaskRunner(
            "tls://127.0.0.1:8786", tls=TlsFiles(*[tmp_path / name for name in ("ca.pem", "c.pem", "k.pem")])
        )


def test_that_a_silent_address_is_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dask_cluster, "ANSWER_SECONDS", 0.3)
    with pytest.raises(MissingRequirement, match="No cluster answers at tcp://127"):
        dask_cluster.DaskRunner(f"tcp://127.0.0.1:{free_port()}")


def test_that_without_dask_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(MissingRequirement, match=r"regolith-studio\[cluster\]"):
        dask_cluster.DaskRunner()
