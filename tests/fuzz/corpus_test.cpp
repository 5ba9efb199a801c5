// Every run of the tests, with any compiler, reads the fuzzers' seeds and their former findings.
#include "core/errors.hpp"
#include "core/files.hpp"
#include "engine/image_file.hpp"
#include "fuzz/entries.hpp"
#include "support/catch.hpp"

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace touchtrial::fuzz {
namespace {

const fs::path kCorpus = fs::path(TOUCHTRIAL_SOURCE_DIR) / "fuzz" / "corpus";

std::vector<fs::path> files_of(std::string_view entry) {
  std::vector<fs::path> files;
  for (const auto& file : fs::directory_iterator(kCorpus / entry)) files.push_back(file.path());
  return files;
}

TEST_CASE("every file of the fuzzers' corpus is accepted or refused in one line") {
  for (const Entry& entry : kEntries) {
    const std::vector<fs::path> files = files_of(entry.name);
    CHECK(files.size() >= 3);
    for (const fs::path& file : files) {
      INFO(file);
      CHECK_NOTHROW(entry.read(read_file(file)));
    }
  }
}

TEST_CASE("every folder of the fuzzers' corpus belongs to an entry") {
  std::set<std::string> folders;
  for (const auto& folder : fs::directory_iterator(kCorpus)) {
    folders.insert(folder.path().filename().string());
  }
  std::set<std::string> names;
  for (const Entry& entry : kEntries) names.emplace(entry.name);
  CHECK(folders == names);
}

TEST_CASE("beginnings of the corpus's files are accepted or refused in one line") {
  for (const Entry& entry : kEntries) {
    for (const fs::path& file : files_of(entry.name)) {
      const Bytes bytes = read_file(file);
      for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 16) {
        INFO(file << ", " << size << " bytes of it");
        CHECK_NOTHROW(entry.read(ByteView(bytes).first(size)));
      }
    }
  }
}

TEST_CASE("the pictures of the corpus are read, except those that broke a reader") {
  int read = 0;
  for (const fs::path& file : files_of("image")) {
    if (file.filename().string().starts_with("found-")) continue;
    INFO(file);
    const GreyImage image = engine::read_grey_image(file);
    CHECK(image.size() <= 20);
    ++read;
  }
  CHECK(read >= 30);
}

}  // namespace
}  // namespace touchtrial::fuzz
