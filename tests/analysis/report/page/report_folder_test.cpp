// The folder of a report: it writes and removes its own files, and no others.
#include "analysis/report/page/report_folder.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/identification/analysis/hand_made_report.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/temp_folder.hpp"

using namespace touchtrial;
using namespace touchtrial::analysis;
using namespace touchtrial::analysis::identification;
namespace fs = std::filesystem;

namespace {

std::string content_of(const fs::path& path) {
  const Bytes bytes = read_file(path);
  return {bytes.begin(), bytes.end()};
}

}  // namespace

TEST_CASE("report folder: holds page, results and every table in both forms") {
  const TempFolder folder;
  const fs::path out = folder.path() / "deep" / "report";
  const Document document = study_document(hand_made_report(), hand_made_provenance());
  write_report_folder(out, report_files(document, "{}\n"));
  CHECK(content_of(out / "results.json") == "{}\n");
  CHECK_THAT(content_of(out / "report.html"), holds_text("<h1>") && names("hand-made"));
  for (const Table* table : tables_of(document)) {
    CHECK(path_exists(out / "tables" / (table->id + ".md")));
    CHECK(path_exists(out / "tables" / (table->id + ".tex")));
  }
}

TEST_CASE("report folder: files of an earlier report are removed, files of others stay") {
  const TempFolder folder;
  const fs::path out = folder.path();
  write_report_folder(out, {{"results.json", "1"}, {"tables/old.md", "x"}, {"tables/a.md", "x"}});
  replace_file(out / "tables" / "mine.md", std::string_view("mine"));
  replace_file(out / "notes.txt", std::string_view("mine"));
  write_report_folder(out, {{"results.json", "2"}, {"tables/a.md", "y"}});
  CHECK_FALSE(path_exists(out / "tables" / "old.md"));
  CHECK(content_of(out / "tables" / "a.md") == "y");
  CHECK(content_of(out / "tables" / "mine.md") == "mine");
  CHECK(content_of(out / "notes.txt") == "mine");
}

TEST_CASE("report folder: a manipulated list removes nothing outside") {
  const TempFolder folder;
  const fs::path out = folder.path() / "report";
  write_report_folder(out, {{"results.json", "1"}});
  replace_file(folder.path() / "precious.md", std::string_view("mine"));
  replace_file(out / "notes.txt", std::string_view("mine"));
  replace_file(
      out / "report-files.txt",
      std::string_view("results.json\ntables/../../precious.md\n../precious.md\nnotes.txt\n"));
  write_report_folder(out, {{"results.json", "2"}});
  CHECK(path_exists(folder.path() / "precious.md"));
  CHECK(path_exists(out / "notes.txt"));
}

TEST_CASE(
    "report folder: refuses the report of another study, and a results.json that is not a "
    "report's") {
  const TempFolder folder;
  const fs::path out = folder.path();
  CHECK_NOTHROW(refuse_other_study(out, "mine"));
  replace_file(out / "results.json", std::string_view("{\"study\": \"mine\"}"));
  CHECK_NOTHROW(refuse_other_study(out, "mine"));
  CHECK_THROWS_AS(refuse_other_study(out, "other"), FileError);
  replace_file(out / "results.json", std::string_view("[1, 2"));
  CHECK_THROWS_AS(refuse_other_study(out, "mine"), FileError);
}

TEST_CASE("report folder: refuses to write over a file that no report's list names") {
  const TempFolder folder;
  const fs::path out = folder.path();
  make_folder(out / "tables");
  CHECK_NOTHROW(refuse_foreign_files(out));
  for (const std::string path : {"report.html", "tables/a.md"}) {
    replace_file(out / path, std::string_view("mine"));
    CHECK_THROWS_AS(write_report_folder(out, {{"results.json", "1"}, {path, "ours"}}), FileError);
    CHECK(content_of(out / path) == "mine");
    CHECK_FALSE(path_exists(out / "results.json"));
  }
  CHECK_THROWS_AS(refuse_foreign_files(out), FileError);
}
