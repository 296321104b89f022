"""Two hosts and batch systems on one machine (tests/cluster); skipped by name where the machine does not allow them."""

import os
import shutil
import subprocess

import pytest
from conftest import PROGRAM, ROOT, datasets, with_extensive

SMALL = ROOT / "scenes" / "small.yaml"
DIRECT = ["--set", "basin.method=direct"]  # enough tiles for both hosts
LARGE = [*DIRECT, "--set", "basin.theta.count=1600", "--set", "basin.velocity.count=1600"]  # some seconds
HOSTS = ["mpirun", "--host", "first:1,second:1", "-n", "2"]
# Shell commands that wait until the run has finished work to lose.
LATER = 'until [ -e small.h5 ] || [ -n "$(find small.h5.checkpoint -size +300k 2>/dev/null)" ]; do sleep 0.1; done;'


def run(tool, folder, *words, **more):
    """A command on a cluster of tests/cluster; skips the test where there can be none."""
    settings = {name: value for name, value in os.environ.items() if name != "OMPI_MCA_pml"} | more
    done = subprocess.run(list(map(str, [ROOT / "tests" / "cluster" / tool, folder / "cluster", *words])), cwd=folder,
                          text=True, capture_output=True, env=settings)
    if done.returncode == 77:
        pytest.skip(done.stderr.strip())
    return done


@pytest.fixture(scope="module")
def alone(kapitza, tmp_path_factory):
    """The datasets of one rank."""
    folder = tmp_path_factory.mktemp("alone")
    kapitza("run", SMALL, *DIRECT, folder=folder)
    return datasets(folder / "small.h5")


@pytest.fixture(scope="module")
def alone_large(kapitza, tmp_path_factory):
    folder = tmp_path_factory.mktemp("large")
    kapitza("run", SMALL, *LARGE, folder=folder)
    return datasets(folder / "small.h5")


def test_two_hosts_over_tcp(tmp_path, alone):
    """Open MPI as it comes: the same bytes as one rank."""
    done = run("two_hosts", tmp_path, "mpirun", "--host", "first:1,second:1", "-n", "2", PROGRAM, "run", SMALL, *DIRECT)
    assert done.returncode == 0, done.stderr
    assert datasets(tmp_path / "small.h5") == alone


def rank_1(signals):
    """What makes rank 1, on the second host, send itself signals once there is work to lose."""
    return ["bash", "-c", f'if [ "$OMPI_COMM_WORLD_RANK" = 1 ]; then ({LATER} {signals}) & fi; exec "$@"', "rank"]


def test_a_stop_on_one_of_two_hosts_reaches_the_other(tmp_path):
    """The request reaches rank 1 alone, once there is work to lose: all stop with status 75 and finished work saved."""
    done = run("two_hosts", tmp_path, *HOSTS, *rank_1("kill -USR1 $$"), PROGRAM, "run", SMALL, *LARGE)
    assert done.returncode == 75 and "stopped by SIGUSR1" in done.stderr, done.stderr
    assert (tmp_path / "small.h5.checkpoint").exists() and not (tmp_path / "small.h5").exists()


def test_a_run_that_is_killed_on_one_host_is_resumed_on_both(tmp_path, alone_large):
    done = run("two_hosts", tmp_path, *HOSTS, *rank_1("kill -KILL $$"), PROGRAM, "run", SMALL, *LARGE)
    assert done.returncode not in (0, 75) and not (tmp_path / "small.h5").exists(), done.stderr
    kept = (tmp_path / "small.h5.checkpoint").stat().st_size
    done = run("two_hosts", tmp_path, *HOSTS, PROGRAM, "run", SMALL, *LARGE, "--resume")
    assert done.returncode == 0 and kept > 300_000, done.stderr
    assert datasets(tmp_path / "small.h5") == alone_large




@pytest.mark.extensive
def test_a_host_that_stands_still_for_a_while_changes_nothing(tmp_path, alone_large):
    done = run("two_hosts", tmp_path, *HOSTS, *rank_1("kill -STOP $$; touch stood; sleep 3; kill -CONT $$"), PROGRAM,
               "run", SMALL, *LARGE)
    assert done.returncode == 0 and (tmp_path / "stood").exists(), done.stderr
    assert datasets(tmp_path / "small.h5") == alone_large


SUBMIT = ["sbatch", "--ntasks=2", "--overcommit", "--time=5", "--output=out"]
SLURM = {"KAPITZA": str(PROGRAM), "LAUNCHER": "srun --mpi=pmix --overcommit"}
BATCH = ROOT / "scripts" / "kapitza.sbatch"


def test_a_batch_job_is_stopped_requeued_and_resumed(tmp_path, alone_large):
    """SIGUSR1 as before a time limit: status 75, back into the queue (there is no need to wait its two minutes),
    resumed, done."""
    # SIGUSR1 can come while the script waits: --batch sends it to the script alone, as #SBATCH --signal=B: does.
    watch = f"""{LATER} scancel --batch --signal=USR1 1
for _ in $(seq 100); do squeue -h -o %r | grep -q BeginTime && break; sleep 0.2; done
scontrol update jobid=1 StartTime=now
while [ -n "$(squeue -h)" ]; do sleep 0.2; done
scontrol show job 1"""
    words = " ".join(map(str, [*SUBMIT, BATCH, SMALL, *LARGE]))
    done = run("one_node_slurm", tmp_path, "bash", "-c", f"{words} && {watch}", **SLURM)
    said = (tmp_path / "out").read_text() if (tmp_path / "out").exists() else done.stderr
    assert "Restarts=1" in done.stdout and "JobState=COMPLETED" in done.stdout, done.stdout + said
    assert "stopped by SIGUSR1" in said and said.count("written to small.h5") == 1
    assert datasets(tmp_path / "small.h5") == alone_large


@pytest.mark.extensive
def test_a_job_array_over_a_parameter(tmp_path):
    few = ["--set", "basin.theta.count=20", "--set", "basin.velocity.count=20", "--set", "basin.attractors.starts=64"]
    words = [*SUBMIT, "--wait", "--array=0-1", BATCH, SMALL, *DIRECT, *few]
    done = run("one_node_slurm", tmp_path, *words, SWEEP="pendulum.drive_amplitude=0.29,0.31", **SLURM)
    assert done.returncode == 0, done.stderr + "".join(path.read_text() for path in tmp_path.glob("out"))
    assert {path.name for path in tmp_path.glob("*.h5")} == {"small-0.29.h5", "small-0.31.h5"}


@pytest.mark.parametrize("status, saves, again", [(75, True, True), (75, False, False), (0, True, False),
                                                  (1, True, False)])
def test_a_pbs_job_is_submitted_again_after_75(tmp_path, status, saves, again):
    """PBS itself is in no Debian package: mpirun and qsub are scripts that write down how they were called. Where
    nothing was saved, the job would come back without end."""
    save = f"touch '{tmp_path}/a, scene.h5.checkpoint'" if saves else ":"
    for name, end in (("mpirun", status), ("qsub", 0)):
        (tmp_path / name).write_text(f'#!/bin/sh\necho "$@" "$SCENE" > {tmp_path}/{name}.called\n{save}\nexit {end}\n')
        (tmp_path / name).chmod(0o755)
    job = {"PBS_O_WORKDIR": str(tmp_path), "SCENE": "a, scene.yaml", "PATH": f"{tmp_path}:{os.environ['PATH']}"}
    settings = {name: value for name, value in os.environ.items() if name != "KAPITZA"} | job
    done = subprocess.run([ROOT / "scripts" / "kapitza.pbs"], env=settings)
    assert done.returncode == status
    assert (tmp_path
            / "mpirun.called").read_text() == "kapitza run a, scene.yaml --resume --time-limit 55m a, scene.yaml\n"
    assert (tmp_path / "qsub.called").exists() == again
    assert not again or (tmp_path
                         / "qsub.called").read_text() == f"-v SCENE {ROOT / 'scripts' / 'kapitza.pbs'} a, scene.yaml\n"


@pytest.mark.parametrize("saves, again", [(True, True), (False, False)])
def test_a_slurm_job_is_queued_again_where_it_saved_something(tmp_path, saves, again):
    """A value with a slash is part of a name; the scheduler is a script that writes down how it was called."""
    save = "touch s-pi_2.h5.checkpoint" if saves else ":"
    for name, text in (("srun", f'echo "$@" > srun.called\n{save}\nexit 75'),
                       ("scontrol", 'echo "$@" > scontrol.called')):
        (tmp_path / name).write_text(f"#!/bin/sh\n{text}\n")
        (tmp_path / name).chmod(0o755)
    job = {"SLURM_JOB_ID": "7", "SLURM_ARRAY_TASK_ID": "1", "SWEEP": "pendulum.tilt=0,pi/2", "LAUNCHER": "srun",
           "PATH": f"{tmp_path}:{os.environ['PATH']}"}
    done = subprocess.run([BATCH, "s.yml"], env=os.environ | job, cwd=tmp_path)
    assert done.returncode == 75 and (tmp_path / "scontrol.called").exists() == again
    assert (tmp_path
            / "srun.called").read_text().split(" run ")[1] == "s.yml --set pendulum.tilt=pi/2 -o s-pi_2.h5 --resume\n"


@pytest.mark.parametrize("sweep, message",
                         [(None, "SWEEP: an array needs the values of its tasks: SWEEP=KEY=VALUE,VALUE,..."),
                                            ("pendulum.tilt=0,0.1", "SWEEP has no value for this task of the array")])
def test_an_array_without_its_values_is_refused_in_words(sweep, message):
    """The line of the docs for arrays ended with `SWEEP: unbound variable`."""
    settings = {name: value for name, value in os.environ.items() if name != "SWEEP"} | {"SLURM_ARRAY_TASK_ID": "2",
                                                                                         "SLURM_JOB_ID": "7"}
    done = subprocess.run([BATCH, "s.yaml"], env=settings | ({"SWEEP": sweep} if sweep else {}), capture_output=True,
                          text=True)
    assert done.returncode != 0 and message in done.stderr, done.stderr


@pytest.mark.parametrize("builds", with_extensive([False], [True]))
def test_the_apptainer_build_has_all_its_files(tmp_path, builds):
    """Its steps on the files that it copies, for the instruction set that it names; no container is needed. Benchmarks
    named files of tests, which neither it nor the sdist has."""
    lines = (ROOT / "packaging" / "images"
             / "kapitza.def").read_text().split("%files\n")[1].split("\n\n")[0].splitlines()
    for name, _ in map(str.split, lines):
        (shutil.copytree if (ROOT / name).is_dir() else shutil.copy)(ROOT / name, tmp_path / name)
    build = tmp_path / "build"
    settings = ["-DCMAKE_BUILD_TYPE=Release", "-DBUILD_TESTING=OFF", "-DKAPITZA_ARCH=x86-64"]
    steps = [["-G", "Ninja", "-S", tmp_path, "-B", build, *settings],
             ["--build", build], ["--install", build, "--prefix", tmp_path / "local"]]
    for words in steps if builds else steps[:1]:
        done = subprocess.run(["cmake", *map(str, words)], capture_output=True, text=True)
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr
    if builds:
        subprocess.run([tmp_path / "local/bin/kapitza", "check", tmp_path / "local/share/kapitza/scenes/small.yaml"],
                       check=True)


@pytest.mark.parametrize("tool, names", [("hadolint", ["packaging/images/Dockerfile"]),
                                         ("shellcheck", ["scripts/kapitza.sbatch", "scripts/kapitza.pbs"])])
def test_linters_find_nothing(tool, names):
    if not shutil.which(tool):
        pytest.skip(f"needs {tool}")
    done = subprocess.run([tool, *names], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
