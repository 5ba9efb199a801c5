#include "core/files.hpp"

#include "core/errors.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <sys/stat.h>

using namespace touchtrial;
namespace fs = std::filesystem;

TEST_CASE("a replaced file holds the new content and leaves nothing beside it") {
  const TempFolder folder;
  const auto path = folder.path() / "a.txt";
  replace_file(path, "old");
  replace_file(path, "new");
  CHECK(text_of(read_file(path)) == "new");
  CHECK(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()) == 1);
}

TEST_CASE("an owner-only file is readable by its owner alone") {
  const TempFolder folder;
  const auto path = folder.path() / "secret";
  replace_file(path, "open", FileMode::everyone);
  replace_file(path, "closed", FileMode::owner_only);
  struct stat status {};
  REQUIRE(::stat(path.c_str(), &status) == 0);
  CHECK((status.st_mode & 0777) == 0600);
}

TEST_CASE("a file that cannot be written is an error that names it, and the old one stays") {
  const TempFolder folder;
  const auto path = folder.path() / "no-such-folder" / "a.txt";
  CHECK_THROWS_AS(replace_file(path, "text"), FileError);
  const auto taken = folder.path() / "taken";
  fs::create_directories(taken / "inside");
  CHECK_THROWS_WITH(replace_file(taken, "text"), holds_text("taken"));
  CHECK(fs::is_directory(taken / "inside"));
  CHECK(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()) == 1);
}

TEST_CASE("a pipe is not replaced") {
  const TempFolder folder;
  const auto pipe = folder.path() / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THROWS_AS(replace_file(pipe, "text"), FileError);
  CHECK(fs::is_fifo(pipe));
}

TEST_CASE("a folder is made with those above it, and a file in its place is named") {
  const TempFolder folder;
  make_folder(folder.path() / "a" / "b");
  make_folder(folder.path() / "a" / "b");
  CHECK(fs::is_directory(folder.path() / "a" / "b"));
  replace_file(folder.path() / "file", "text");
  CHECK_THROWS_WITH(make_folder(folder.path() / "file" / "b"), holds_text("file"));
  CHECK(path_exists(folder.path() / "file"));
  CHECK_FALSE(path_exists(folder.path() / "file" / "b"));
}

TEST_CASE("a missing file, a folder and a file over the limit are refused by name") {
  const TempFolder folder;
  CHECK_THROWS_WITH(read_file(folder.path() / "gone"), holds_text("gone"));
  CHECK_THROWS_AS(read_file(folder.path()), FileError);
  const auto path = folder.path() / "big";
  replace_file(path, "12345");
  CHECK_THROWS_AS(read_file(path, 4), FileError);
  CHECK(read_file(path, 5).size() == 5);
}

TEST_CASE("a mapped file shows the file's bytes") {
  const TempFolder folder;
  const auto path = folder.path() / "a";
  replace_file(path, "mapped");
  MappedFile file(path);
  CHECK(text_of(file.bytes()) == "mapped");
  const MappedFile moved(std::move(file));
  CHECK(text_of(moved.bytes()) == "mapped");
  replace_file(path, "");
  CHECK_THROWS_AS(MappedFile(path), FileError);
  CHECK_THROWS_AS(MappedFile(folder.path() / "gone"), FileError);
}

TEST_CASE("a hostile name cannot break an error message into lines") {
  CHECK(one_line("a\nb\tc\x7f") == "a b c ");
  try {
    (void)read_file("no\nsuch\rfile");
    FAIL("reading a missing file did not fail");
  } catch (const FileError& error) {
    CHECK(std::string(error.what()).find_first_of("\n\r") == std::string::npos);
  }
}
