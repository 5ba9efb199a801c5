#include "core/outputs.hpp"

#include "core/errors.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/temp_folder.hpp"

#include <fstream>
#include <utility>
#include <vector>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace touchtrial;
namespace fs = std::filesystem;

namespace {

/// As an editor or another program writes.
void scribble(const fs::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

std::string text_in(const fs::path& file) {
  return text_of(read_file(file));
}

int files_in(const fs::path& folder) {
  return static_cast<int>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

/// While it lives, files in the way are kept.
struct Keeping {
  Keeping() {
    move_foreign_files_aside([this](const fs::path& file, const fs::path& as) {
      kept.emplace_back(file.filename().string(), as.filename().string());
    });
  }
  ~Keeping() { move_foreign_files_aside({}); }
  Keeping(const Keeping&) = delete;
  Keeping& operator=(const Keeping&) = delete;

  std::vector<std::pair<std::string, std::string>> kept;
};

/// Makes a draft in a process of its own, which is killed while it holds it.
void leave_draft(const fs::path& place, Draft::Kind kind) {
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    const Draft draft(place, kind);
    if (kind == Draft::Kind::folder) scribble(draft.path() / "inside", "half");
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  REQUIRE(WIFSIGNALED(status));
}

}  // namespace

TEST_CASE("an output replaces only an unchanged output") {
  const TempFolder folder;
  const fs::path place = folder.path() / "a.txt";
  CHECK(origin_of(place) == Origin::nothing);
  write_output(place, "first");
  CHECK(origin_of(place) == Origin::ours);
  write_output(place, "second");
  CHECK(text_in(place) == "second");

  scribble(place, "mine");
  CHECK(origin_of(place) == Origin::foreign);
  CHECK_THROWS_WITH(write_output(place, "third"), holds_text("--force"));
  CHECK_THROWS_AS(require_output_path(place), FileError);
  CHECK(text_in(place) == "mine");
  CHECK(files_in(folder.path()) == 1);
  write_output(place, "mine");  // nothing is lost
  CHECK(origin_of(place) == Origin::ours);

  fs::create_directory(folder.path() / "b.txt");
  CHECK_THROWS_AS(write_output(folder.path() / "b.txt", "text"), FileError);
}

TEST_CASE("a pipe or a device is never moved away") {
  const TempFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  const Keeping keeping;
  CHECK_THROWS_AS(write_output(pipe, "text"), FileError);
  CHECK_THROWS_AS(clear_output_path(pipe), FileError);
  CHECK(fs::is_fifo(pipe));
}

TEST_CASE("a file in the way is renamed to the first free number, on request") {
  const TempFolder folder;
  const fs::path place = folder.path() / "a.txt";
  Keeping keeping;
  for (const std::string mine : {"mine", "mine again"}) {
    scribble(place, mine);
    require_output_path(place);
    write_output(place, "ours");
    CHECK(text_in(place) == "ours");
  }
  CHECK(text_in(folder.path() / "a.txt.1") == "mine");
  CHECK(text_in(folder.path() / "a.txt.2") == "mine again");
  CHECK(keeping.kept == std::vector<std::pair<std::string, std::string>>{{"a.txt", "a.txt.1"},
                                                                         {"a.txt", "a.txt.2"}});
  fs::create_directory(folder.path() / "pictures");
  clear_output_path(folder.path() / "pictures/");
  CHECK(fs::is_directory(folder.path() / "pictures.1"));
}

TEST_CASE("nothing is written through a link, whatever it leads to") {
  const TempFolder folder;
  const fs::path target = folder.path() / "target";
  const fs::path link = folder.path() / "link";
  fs::create_symlink(target, link);
  const Keeping keeping;  // which does not help
  for (const bool is_dangling : {true, false}) {
    if (!is_dangling) scribble(target, "mine");
    const auto names_both = names(target.string());
    CHECK_THROWS_WITH(write_output(link, "ours"), names_both);
    CHECK_THROWS_WITH(replace_file(link, "ours"), names_both);
    CHECK_THROWS_WITH(refuse_link(link), names_both);
    CHECK(path_exists(target) == !is_dangling);
  }
  CHECK(text_in(target) == "mine");
  fs::create_directory(folder.path() / "real");
  fs::create_directory_symlink(folder.path() / "real", folder.path() / "alias");
  write_output(folder.path() / "alias" / "a.txt", "ours");
  CHECK(text_in(folder.path() / "real" / "a.txt") == "ours");
}

TEST_CASE("an output leaves the other name of a file alone") {
  const TempFolder folder;
  const fs::path place = folder.path() / "a.txt";
  write_output(place, "first");
  fs::create_hard_link(place, folder.path() / "b.txt");
  write_output(place, "second");
  CHECK(text_in(folder.path() / "b.txt") == "first");
}

TEST_CASE("a complete file is moved to an output's place by the same rule") {
  const TempFolder folder;
  const fs::path made = folder.path() / "made";
  const fs::path place = folder.path() / "place";
  for (const std::string text : {"first", "second"}) {
    scribble(made, text);
    move_to_output(made, place);
    CHECK(text_in(place) == text);
    CHECK_FALSE(path_exists(made));
  }
  scribble(place, "mine");
  scribble(made, "third");
  CHECK_THROWS_AS(move_to_output(made, place), FileError);
  CHECK(text_in(place) == "mine");
}

TEST_CASE(
    "drafts of programs that were killed are removed, those of living ones and others' are not") {
  const TempFolder folder;
  for (const Draft::Kind kind : {Draft::Kind::file, Draft::Kind::folder}) {
    const fs::path below = folder.path() / (kind == Draft::Kind::file ? "file" : "folder");
    fs::create_directory(below);
    leave_draft(below / "a.txt", kind);
    scribble(below / "mine.tmp123", "mine");
    scribble(below / ".touchtrial-mine.tmp", "mine");
    CHECK(files_in(below) == 3);
    const Draft living(below / "b.txt", kind);
    CHECK(files_in(below) == 3);
    write_output(below / "a.txt", "whole");
    CHECK(files_in(below) == 4);
    CHECK(path_exists(living.path()));
  }
}

TEST_CASE("a draft is renamed to a free path or replaces a file, and is removed otherwise") {
  const TempFolder folder;
  const fs::path place = folder.path() / "a.txt";
  {
    const Draft dropped(place, Draft::Kind::file);
    dropped.write(bytes_of("half"));
  }
  CHECK(files_in(folder.path()) == 0);
  for (const std::string text : {"first", "second"}) {
    Draft draft(place, Draft::Kind::file);
    draft.write(bytes_of(text));
    CHECK(draft.rename_if_free() == (text == "first"));
  }
  CHECK(text_in(place) == "first");
  CHECK(files_in(folder.path()) == 1);
  CHECK_THROWS_WITH(Draft(folder.path() / "gone" / "a.txt", Draft::Kind::folder),
                    holds_text("gone/a.txt"));
}
