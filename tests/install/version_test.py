#!/usr/bin/env python3
"""version_test.py SOURCE: which commit a build names, and what scripts/source-archive makes of it.

Both are tried on small repositories, in which a tree has only what they read.
"""
import os, pathlib, shutil, subprocess, sys, tarfile, tempfile

SOURCE = pathlib.Path(sys.argv[1])
READ = ["CMakeLists.txt", ".gitattributes", "app/commit.cpp.in", "cmake/Commit.cmake", "cmake/commit.txt",
        "scripts/source-archive"]


def run(*command, **variables):
    done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          env={**os.environ, **variables})
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout.decode()[-3000:]}")
    return done.stdout.decode()


def git(tree, *words):
    return run("git", "-C", tree, "-c", "user.name=A", "-c", "user.email=a@example.org", *words).strip()


def commit_of(tree, **variables):
    """What a build of the tree would name."""
    output = tree.parent / "commit.cpp"
    said = run("cmake", "-D", f"SOURCE={tree}", "-D", f"TEMPLATE={SOURCE}/app/commit.cpp.in", "-D",
               f"OUTPUT={output}", "-P", SOURCE / "cmake/Commit.cmake", **variables)
    check("nothing is said of it", said == "")
    return output.read_text().partition('return "')[2].partition('"')[0]


def check(name, is_so):
    if not is_so:
        sys.exit(f"NOT OK  {name}")
    print(f"ok      {name}")


def copied(tree):
    for name in READ:
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(SOURCE / name, tree / name)
    return tree


def main(work):
    os.environ.update(GIT_CONFIG_GLOBAL=os.devnull, GIT_CONFIG_NOSYSTEM="1")
    for name in run("git", "rev-parse", "--local-env-vars").split():
        os.environ.pop(name, None)
    tree = copied(work / "tree")
    # As in a repository, also where the sources that are tested come from an archive.
    (tree / "cmake/commit.txt").write_text("$Format:%H$\n")
    check("without a repository no commit is named", commit_of(tree) == "")
    git(tree, "init", "-q")
    check("nor before the first one", commit_of(tree) == "")
    git(tree, "add", ".")
    git(tree, "commit", "-q", "-m", "First")
    first = git(tree, "rev-parse", "HEAD")
    check("a repository's commit is named by eight digits", commit_of(tree) == first[:8])
    written = (work / "commit.cpp").stat().st_mtime_ns
    (tree / "notes.txt").write_text("untracked\n")
    check("new files that are no sources do not count", commit_of(tree) == first[:8])
    check("the same commit is not written again", (work / "commit.cpp").stat().st_mtime_ns == written)
    for new in ("app/new.cpp", "config/devices/new.json"):
        (tree / new).parent.mkdir(parents=True, exist_ok=True)
        (tree / new).touch()
        check(f"{new}, which is compiled in, counts as a change", commit_of(tree) == f"{first[:8]}, modified")
        (tree / new).unlink()
    (tree / "CMakeLists.txt").open("a").write("# a change\n")
    check("so does a changed file", commit_of(tree) == f"{first[:8]}, modified")
    git(tree, "commit", "-q", "-a", "-m", "Second")
    second = git(tree, "rev-parse", "HEAD")
    check("a new commit is named at the next build", commit_of(tree) == second[:8] != first[:8])
    check("a repository of another user is left alone",
          commit_of(tree, GIT_TEST_ASSUME_DIFFERENT_OWNER="1") == "")

    around = work / "around"
    around.mkdir()
    git(around, "init", "-q")
    git(around, "commit", "-q", "--allow-empty", "-m", "Around")
    check("a hook's repository is not asked", commit_of(tree, GIT_DIR=str(around / ".git")) == second[:8])
    vendored = copied(around / "vendored")
    (vendored / "cmake/commit.txt").write_text("$Format:%H$\n")
    check("a repository around the tree is not asked", commit_of(vendored) == "")
    (vendored / ".git").mkdir()
    check("nor in place of a broken one", commit_of(vendored) == "")
    git(work, "clone", "-q", "--depth", "1", f"file://{tree}", work / "shallow")
    check("a shallow clone is enough", commit_of(work / "shallow") == second[:8])

    said = run(tree / "scripts/source-archive", work / "packages")
    check("uncommitted changes are told in one line", said.count("\n") == 2 and "uncommitted changes" in said)
    [archive] = (work / "packages").glob("*.tar.xz")
    version = archive.name.removeprefix("touchtrial-").removesuffix(".tar.xz")
    check("the archive has the project's version", f"VERSION {version} " in (tree / "CMakeLists.txt").read_text())
    run(tree / "scripts/source-archive", work / "again", GIT_CONFIG_COUNT="2",
        GIT_CONFIG_KEY_0="core.autocrlf", GIT_CONFIG_VALUE_0="true",
        GIT_CONFIG_KEY_1="tar.umask", GIT_CONFIG_VALUE_1="0077")
    check("and the same bytes under other settings of git",
          archive.read_bytes() == (work / "again" / archive.name).read_bytes())
    (work / "packages" / "one.deb").write_text("a package\n")
    run(tree / "scripts/source-archive", work / "packages")
    sums = run("sh", "-c", 'cd "$0" && sha256sum -c SHA256SUMS', work / "packages")
    check("checksums of archive and packages hold", sums.splitlines() == ["one.deb: OK", f"{archive.name}: OK"])
    with tarfile.open(archive) as tar:
        tar.extractall(around)
    check("sources from the archive know their commit, in a repository too",
          commit_of(around / f"touchtrial-{version}") == second[:8])
    check("and what was not committed is not among them",
          not (around / f"touchtrial-{version}" / "notes.txt").exists())


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        main(pathlib.Path(folder).resolve())
