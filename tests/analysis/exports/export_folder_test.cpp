#include "analysis/exports/export_folder.hpp"

#include "analysis/exports/csv_reading.hpp"
#include "analysis/text_matching.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/refusal.hpp"
#include "support/temp_folder.hpp"

namespace touchtrial {
namespace {

const analysis::ExportMark kOurs{"pair", "aa11", "csv"};

analysis::ExportFile file(const std::string& name, const std::string& content) {
  return analysis::text_file(name, content);
}

}  // namespace

TEST_CASE("A second export removes what the first wrote and it does not hold, with its folders") {
  const TempFolder folder;
  analysis::write_export(folder.path(), kOurs,
                         {file("sub-1/a.txt", "1"), file("sub-2/beh/b.txt", "2")});
  replace_file(folder.path() / "mine.txt", "mine");
  analysis::write_export(folder.path(), kOurs, {file("sub-1/a.txt", "3")});
  CHECK(text_of_file(folder.path() / "sub-1/a.txt") == "3");
  CHECK_FALSE(path_exists(folder.path() / "sub-2"));
  CHECK(text_of_file(folder.path() / "mine.txt") == "mine");
}

TEST_CASE("A folder with another study's export is refused untouched") {
  const TempFolder folder;
  analysis::write_export(folder.path(), {"single", "bb22", "csv"}, {file("trials.csv", "theirs")});
  const std::string complaint = message_of<FileError>([&] {
    analysis::write_export(folder.path(), kOurs,
                           {file("other.csv", "ours"), file("trials.csv", "ours")});
  });
  CHECK(contains(complaint, "single"));
  CHECK(text_of_file(folder.path() / "trials.csv") == "theirs");
  CHECK_FALSE(path_exists(folder.path() / "other.csv"));
}

TEST_CASE("A file that no export wrote is not overwritten") {
  const TempFolder folder;
  replace_file(folder.path() / "trials.csv", "mine");
  const std::string complaint = message_of<FileError>([&] {
    analysis::write_export(folder.path(), kOurs,
                           {file("other.csv", "ours"), file("trials.csv", "ours")});
  });
  CHECK(contains(complaint, "trials.csv"));
  CHECK(text_of_file(folder.path() / "trials.csv") == "mine");
  CHECK_FALSE(path_exists(folder.path() / "other.csv"));
}

TEST_CASE("An interrupted export can be repeated") {
  const TempFolder folder;
  const auto fail = [](const std::filesystem::path&) { throw FileError("disk full"); };
  CHECK_THROWS_AS(analysis::write_export(folder.path(), kOurs,
                                         {file("a.csv", "1"), {"b.csv", fail}, file("c.csv", "1")}),
                  FileError);
  CHECK(text_of_file(folder.path() / "a.csv") == "1");
  analysis::write_export(folder.path(), kOurs, {file("b.csv", "2")});
  CHECK(text_of_file(folder.path() / "b.csv") == "2");
  CHECK_FALSE(path_exists(folder.path() / "a.csv"));
}

TEST_CASE("Tables of one study share a folder, and a dataset has one of its own") {
  const TempFolder folder;
  analysis::write_export(folder.path(), kOurs, {file("trials.csv", "1")});
  analysis::write_export(folder.path(), {"pair", "aa11", "json"}, {file("study.json", "{}")});
  CHECK(path_exists(folder.path() / "trials.csv"));
  CHECK_THROWS_AS(
      analysis::write_export(folder.path(), {"pair", "aa11", "bids"}, {file("README", "dataset")}),
      FileError);
}

TEST_CASE("A mark that was tampered with removes nothing outside of its folder") {
  const TempFolder folder;
  const std::filesystem::path out = folder.path() / "out";
  replace_file(folder.path() / "precious.txt", "mine");
  make_folder(out);
  replace_file(out / analysis::kExportMark,
               R"({"study":"pair","study_id":"aa11","files":{"csv":["../precious.txt"]}})");
  analysis::write_export(out, kOurs, {file("a.csv", "1")});
  CHECK(path_exists(folder.path() / "precious.txt"));
}

TEST_CASE("A file that is not a valid mark is named") {
  const TempFolder folder;
  replace_file(folder.path() / analysis::kExportMark, "{");
  const std::string complaint = message_of<FileError>(
      [&] { analysis::write_export(folder.path(), kOurs, {file("a.csv", "1")}); });
  CHECK(contains(complaint, analysis::kExportMark));
}

}  // namespace touchtrial
