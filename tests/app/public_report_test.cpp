// report --public, as a user runs it.
#include "app/study_folder.hpp"
#include "support/catch.hpp"

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
  succeeded(study.simulate("s.db"));
  study.done("exclude @s.db --participant P003 --reason qqreason --after-outcomes");
  study.done("note @s.db --participant P001 --deviation qqcode --own-code qqnote");
  const auto report = [&](std::vector<std::string> more) {
    const ProgramResult ran = succeeded(study.type("report @s.db", more));
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
  succeeded(study.simulate("s.db", {"--keep-blind"}));
  check_refused(study.type("report @s.db --public"), 2, {"--public"});
  CHECK(study.type("report @s.db --public --out @o --trial P001:1").exit_code == 2);
}
