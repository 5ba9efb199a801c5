#include "core/file_stamp.hpp"

#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <string>

namespace touchtrial {

using namespace std::chrono_literals;

TEST_CASE("a file that nobody touched is unchanged, and another size, name or time is a change") {
  const TempFolder folder;
  const auto file = folder.path() / "one";
  replace_file(file, std::string("abc"));
  const auto before = stamp_of(file);
  REQUIRE(before);
  CHECK(before->bytes == 3);
  CHECK(is_unchanged(*before, *stamp_of(file), 0s));
  SECTION("another time of its content") {
    std::filesystem::last_write_time(file, std::filesystem::last_write_time(file) - 1h);
    CHECK_FALSE(is_unchanged(*before, *stamp_of(file), 0s));
  }
  SECTION("another size") {
    std::filesystem::resize_file(file, 2);
    CHECK_FALSE(is_unchanged(*before, *stamp_of(file), 0s));
  }
  SECTION("another file of its name") {
    replace_file(file, std::string("abd"));
    CHECK_FALSE(is_unchanged(*before, *stamp_of(file), 0s));
  }
}

TEST_CASE("a file that changed shortly before it was noted may have changed again at once") {
  FileStamp stamp{.bytes = 3, .inode = 1, .modified_ns = 5, .changed_ns = 7, .taken_ns = 107};
  CHECK(is_unchanged(stamp, stamp, 100ns));
  CHECK_FALSE(is_unchanged(stamp, stamp, 101ns));
  stamp.modified_ns = 1000;  // in the future
  CHECK_FALSE(is_unchanged(stamp, stamp, 0ns));
}

TEST_CASE("what is no file has no stamp") {
  const TempFolder folder;
  CHECK_FALSE(stamp_of(folder.path()));
  CHECK_FALSE(stamp_of(folder.path() / "none"));
}

}  // namespace touchtrial
