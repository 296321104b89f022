"""The manual page and the completions: every command and option of the help is in them, and the shells understand
them."""

import re
import shutil
import subprocess

import pytest
from conftest import PROGRAM

COMMANDS = ["run", "check", "where", "view", "plot", "info", "fit", "needs", "keys"]


def output(*arguments):
    done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def options_of(*command):
    return re.findall(r"^ +(?:-\w, )?(--[\w-]+)", output(*command, "--help"), re.MULTILINE)


def needs(tool):
    if not shutil.which(tool):
        pytest.skip(f"{tool} is not installed: what kapitza prints for it is not tested with it")


def in_shell(tool, script, *arguments):
    done = subprocess.run([tool, *arguments, "-c", script], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, ""), done.stderr
    return done.stdout.split()


def typed(line):
    """The line with the program where it stands: the scripts ask the one that is typed."""
    return line.replace("kapitza", str(PROGRAM), 1)


def bash(line):
    """What bash offers at the end of a line."""
    words = " ".join(f"'{word}'" for word in typed(line).split(" "))
    return in_shell("bash", f"compopt() {{ :; }}; source <('{PROGRAM}' --completion bash); COMP_WORDS=({words}); "
                            'COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _kapitza; echo "${COMPREPLY[@]}"', "--norc")


def fish(line):
    """The same of fish, whose answers are words and descriptions with a tab between."""
    done = subprocess.run(["fish", "--no-config", "-c",
                           f"'{PROGRAM}' --completion fish | source; complete -C '{typed(line)}'"],
                          capture_output=True, text=True)
    assert done.returncode == 0 and done.stderr == "", done.stderr
    return [row.split("\t")[0] for row in done.stdout.splitlines()]


@pytest.mark.parametrize("shell", [bash, fish])
def test_commands_options_and_keys_are_completed(shell):
    needs(shell.__name__)
    assert set(COMMANDS) <= set(shell("kapitza "))
    for command in COMMANDS:
        assert sorted(set(options_of(command))) == sorted(word for word in shell(f"kapitza {command} --")
                                                          if word.startswith("--"))
    assert sorted(shell("kapitza run --progress ")) == ["always", "auto", "never"]
    assert "basin.theta.count=" in shell("kapitza check --set basin.theta.c")


def test_zsh_understands_its_completion(tmp_path):
    needs("zsh")
    (tmp_path / "_kapitza").write_text(output("--completion", "zsh"))
    subprocess.run(["zsh", "-n", tmp_path / "_kapitza"], check=True)
    script = f"_describe() {{ print -l -- ${{(P)2}}; }}; _files() {{ print FILES; }}; source {tmp_path}/_kapitza"
    found = in_shell("zsh", f"words=({PROGRAM} run --); CURRENT=3; {script}", "-f")
    assert sorted(word.split(":")[0] for word in found if word.startswith("--")) == sorted(set(options_of("run")))
    assert in_shell("zsh", f"words=({PROGRAM} run -o ''); CURRENT=4; {script}", "-f") == ["FILES"]


def test_the_manual_page_has_every_option_and_no_warning(tmp_path):
    text = output("--manual")
    plain = text.replace("\\-", "-")
    for option in {option for command in COMMANDS for option in options_of(command)} | set(options_of()):
        assert f"\\fB{option}\\fR" in plain, option
    needs("groff")
    done = subprocess.run(["groff", "-man", "-Tascii", "-ww"], input=text, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "") and "EXIT STATUS" in re.sub(".\x08", "", done.stdout)


def test_an_unknown_shell_is_refused():
    done = subprocess.run([PROGRAM, "--completion", "csh"], capture_output=True, text=True)
    assert done.returncode == 2
    assert done.stderr == 'kapitza: error: --completion: "csh" is unknown; it must be bash, zsh or fish\n'
