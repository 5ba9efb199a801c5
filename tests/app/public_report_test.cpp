// report --public, as a user runs it.
#include "app/study_folder.hpp"
#include "support/catch.hpp"

#include <string>
#include <vector>

using namespace touchtrial;

namespace {

/// Every file of a folder with its name. A figure's PDF, which is compressed, is drawn from the
/// script of its SVG.
std::string folder_text(const fs::path& folder) {
  std::string all;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const bool is_text = entry.is_regular_file() && entry.path().extension() != ".pdf";
    if (is_text) all += entry.path().filename().string() + content(entry.path());
  }
  return all;
}

}  // namespace

TEST_CASE("report --public writes neither ids nor reasons, in text, page, JSON and figures") {
  const StudyFolder study;
  REQUIRE(study.simulate("s.db").exit_code == 0);
  const ProgramResult excluded = study.run({"exclude", study.in("s.db"), "--participant", "P003",
                                            "--reason", "qqreason", "--after-outcomes"});
  INFO(excluded.errors);
  REQUIRE(excluded.exit_code == 0);
  const ProgramResult noted = study.run({"note", study.in("s.db"), "--participant", "P001",
                                         "--deviation", "qqcode", "--own-code", "qqnote"});
  INFO(noted.errors);
  REQUIRE(noted.exit_code == 0);
  const auto report = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {"report", study.in("s.db")};
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult ran = study.run(words);
    INFO(ran.errors);
    REQUIRE(ran.exit_code == 0);
    return ran.output;
  };
  report({"--out", study.in("whole")});
  report({"--out", study.in("open"), "--public"});
  const std::string whole = folder_text(study.path() / "whole");
  const std::string open =
      folder_text(study.path() / "open") + report({"--public"}) + report({"--public", "--json"});
  for (const std::string planted :
       {"P001", "P002", "P003", "P004", "qqreason", "qqcode", "qqnote", "session 1"}) {
    INFO(planted);
    CHECK_THAT(open, !holds_text(planted));
  }
  for (const std::string planted : {"P001", "P003", "qqreason", "qqcode"}) {
    INFO(planted);
    CHECK_THAT(whole, holds_text(planted));
  }
}

TEST_CASE("report --public is refused before unblinding, and with a trial's exploration") {
  const StudyFolder study;
  REQUIRE(study.simulate("s.db", {"--keep-blind"}).exit_code == 0);
  const ProgramResult blind = study.run({"report", study.in("s.db"), "--public"});
  CHECK(blind.exit_code == 2);
  CHECK_THAT(blind.errors, holds_text("omit --public"));
  CHECK(study
            .run({"report", study.in("s.db"), "--public", "--out", study.in("o"), "--trial",
                  "P001:1"})
            .exit_code == 2);
}
