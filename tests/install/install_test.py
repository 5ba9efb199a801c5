#!/usr/bin/env python3
"""install_test.py BUILD SOURCE: installs a build, moves the tree elsewhere, and uses it as strangers do.

The moved program runs the demo, the C++ example is built against the moved library, and completions and
manual pages are asked. Nothing of the installed tree may name the source or the build folder.
"""
import os, pathlib, shutil, subprocess, sys, tempfile

BUILD, SOURCE = map(pathlib.Path, sys.argv[1:3])


def run(*command, **options):
    done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout.decode()[-3000:]}")
    return done.stdout.decode()


def completed(script, *words):
    """What bash offers for the last of the words."""
    answer = run("bash", "-c", 'source "$0"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _touchtrial; '
                 'echo "${COMPREPLY[@]}"', script, *words)
    return answer.split()


def check(name, is_so):
    print(("ok      " if is_so else "NOT OK  ") + name)
    if not is_so:
        sys.exit(1)


def main(work):
    run("cmake", "--install", BUILD, "--prefix", work / "first")
    tree = work / "elsewhere" / "tree"
    tree.parent.mkdir()
    shutil.move(work / "first", tree)
    program = tree / "bin" / "touchtrial"
    home = work / "home"
    home.mkdir()
    # A machine that builds Touchtrial has Ninja, and perhaps no make.
    os.environ.update(HOME=str(home), XDG_CACHE_HOME=str(home / ".cache"), CMAKE_GENERATOR="Ninja")

    traces = [path.relative_to(tree) for path in tree.rglob("*") if path.is_file()
              and any(os.fsencode(folder) + b"/" in path.read_bytes() for folder in (BUILD, SOURCE, work / "first"))]
    check(f"no installed file names the source or the build folder: {[str(path) for path in traces]}", not traces)

    demo = run(program, "demo", work / "demo", cwd=work).splitlines()
    check("demo ends with both reports",
          all((work / "demo" / f"{study}-report" / "report.html").exists() for study in ("classification", "comparison")))
    page = (SOURCE / "docs" / "report.md").read_text()
    told = page.partition("```text\n[SIMULATED]")[2].partition("```")[0].splitlines()[1:]
    check(f"the tables in docs/report.md are the demo's: {len(told)} lines",
          len(told) > 20 and [line for line in told if line not in demo] == [])
    mean = "".join(told).partition("*")[2].partition("%")[0]
    check(f"the README has its mean, {mean} %", f"name {mean} % of five textures" in
          " ".join((SOURCE / "README.md").read_text().split()))
    again = subprocess.run([program, "demo", work / "demo"], capture_output=True, text=True)
    check("demo refuses a folder that is not empty", again.returncode == 2 and str(work / "demo") in again.stderr)

    nameless = subprocess.run([program, "examples", ""], capture_output=True, text=True, cwd=work)
    check("examples wants a name", nameless.returncode == 2 and not (work / "config").exists())
    own = tree / "share/touchtrial/config/classification.json"
    inside = subprocess.run([program, "simulate", own, "--participants", "1", "--db", work / "own.db"],
                            capture_output=True, text=True)
    check("no pack is made in the installation",
          inside.returncode == 2 and "touchtrial examples" in inside.stderr and not list(own.parent.glob("*.pack")))

    server = subprocess.run([program, "merge", f"postgresql:///study?host={work}", "-o", work / "all.db"],
                            capture_output=True, text=True)
    check("merge finds the module for servers", server.returncode == 1 and ".s.PGSQL." in server.stderr)  # libpq's

    run(program, "examples", work / "mine")
    studies = sorted((work / "mine" / "config").glob("*.json"))
    ready = [study for study in studies if study.name != "devices.json"]
    check("examples copies every ready study",
          [study.name for study in studies] == sorted(path.name for path in (SOURCE / "config").glob("*.json")))
    for study in ready:
        run(program, "prepare", study)
    packs = list((work / "mine" / "config").glob("*.pack"))
    check(f"all {len(ready)} of them can be prepared", len(packs) == len(ready) > 5)

    run("cmake", "-S", tree / "share/doc/libtouchtrial-dev/examples", "-B", work / "example",
        f"-DCMAKE_PREFIX_PATH={tree}", "-DCMAKE_BUILD_TYPE=Release")
    run("cmake", "--build", work / "example")
    picture = work / "mine" / "stimuli" / "bark.png"
    lines = run(work / "example" / "example", picture, work / "example.png").splitlines()
    run(program, "extract", picture, "--precision", "double", "-o", work / "program.png")
    check("the C++ example has the program's texture, byte for byte",
          (work / "example.png").read_bytes() == (work / "program.png").read_bytes())
    check("and forces of a wall of 0.4 N/mm at 1 mm",
          len(lines) == 21 and all(0.0 < float(line.split(",")[4]) < 3.3 for line in lines[1:]))

    (work / "twice").mkdir()
    (work / "twice" / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.22)\nproject(twice LANGUAGES CXX)\n" +
        "".join(f"add_subdirectory({folder})\n" for folder in ("one", "two")))
    for folder in ("one", "two"):
        (work / "twice" / folder).mkdir()
        (work / "twice" / folder / "CMakeLists.txt").write_text(
            "find_package(touchtrial REQUIRED)\nfind_package(touchtrial REQUIRED)\n"
            f"add_executable({folder} {SOURCE}/examples/engine/main.cpp)\n"
            f"target_link_libraries({folder} PRIVATE touchtrial::engine)\n")
    run("cmake", "-S", work / "twice", "-B", work / "twice/build", f"-DCMAKE_PREFIX_PATH={tree}")
    run("cmake", "--build", work / "twice/build", "--target", "two")
    (work / "without").mkdir()
    (work / "without" / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.22)\nproject(without LANGUAGES CXX)\nfind_package(touchtrial QUIET)\n"
        "message(STATUS \"found ${touchtrial_FOUND}: ${touchtrial_NOT_FOUND_MESSAGE}\")\n")
    said = run("cmake", "-S", work / "without", "-B", work / "without/build", f"-DCMAKE_PREFIX_PATH={tree}",
               "-DCMAKE_DISABLE_FIND_PACKAGE_TIFF=ON")
    check("it can be found from several folders, and says what it lacks",
          "found 0: libraries that the engine needs are missing: TIFF." in said)

    headers = [path.relative_to(tree / "include/touchtrial") for path in (tree / "include/touchtrial").rglob("*.hpp")]
    (work / "headers.cpp").write_text("".join(f'#include "{path}"\n' for path in sorted(headers)))
    run("c++", "-std=c++20", "-fsyntax-only", "-Wall", "-Werror", "-I", tree / "include/touchtrial", work / "headers.cpp")
    third = [line for path in headers for line in (tree / "include/touchtrial" / path).read_text().splitlines()
             if line.startswith("#include <") and ("opencv" in line or "hwy" in line or "fftw" in line)]
    check(f"all {len(headers)} headers compile by themselves, and show no library: {third}", not third)

    modules = tree / "lib/python3/dist-packages"
    if (modules / "touchtrial").exists():
        run(program, "extract", picture, "--dump", work / "dump")
        run("/usr/bin/python3", "-B", "-c", "import sys, numpy, touchtrial; texture = touchtrial.extract(sys.argv[1]).texture; "
            "assert texture.tobytes() == numpy.load(sys.argv[2]).tobytes() and texture.size == 250000",
            picture, work / "dump" / "texture.npy", env={**os.environ, "PYTHONPATH": str(modules)})
        check("the moved Python package extracts what the program does, bit for bit", True)

    script = tree / "share/bash-completion/completions/touchtrial"
    check("completion knows commands", completed(script, program, "device", "acc") == ["accept"])
    check("completion knows options", "--precision" in completed(script, program, "extract", "--pre"))
    check("completion knows values",
          completed(script, program, "extract", "--precision", "") == ["float", "double"])
    check("completion knows device models", "falcon" in completed(script, program, "simulate", "--on", ""))
    check("completion leaves files to the shell", completed(script, program, "extract", "-o", "") == [])
    commands = [line.split()[0] for line in run(program, "--help").partition("Options:")[0].splitlines()
                if line.startswith("  ") and not line.startswith("   ") and not line.startswith("  touchtrial ")]
    pages = {path.name for path in (tree / "share/man/man1").iterdir()}
    missing = [name for name in commands if f"touchtrial-{name}.1.gz" not in pages]
    check(f"every command of {len(commands)} has its manual page: {missing}", len(commands) > 25 and not missing)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        main(pathlib.Path(folder))
