// The folder of a report. Figures are drawn only if gnuplot is installed.
#include "app/study_folder.hpp"
#include "support/catch.hpp"

using namespace touchtrial;

namespace {

/// The texts of all files of a report, except figures and the list of files.
std::string texts_in(const fs::path& folder) {
  std::string all;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const bool figure = entry.path().parent_path().filename() == "figures";
    if (entry.is_regular_file() && !figure) all += content(entry.path());
  }
  return all;
}

ProgramResult without_gnuplot(const StudyFolder& study, const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {"PATH=" + study.in("nowhere"), TOUCHTRIAL_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return run_program("/usr/bin/env", study.path(), words);
}

}  // namespace

TEST_CASE(
    "report --out without gnuplot writes everything except drawings, and says so in one line") {
  const StudyFolder study;
  succeeded(study.simulate("s.db"));
  const std::vector<std::string> report = {"report", study.in("s.db"), "--out", study.in("out")};
  const ProgramResult ran = succeeded(without_gnuplot(study, report));
  CHECK(ran.output == study.in("out/report.html") + "\n");
  CHECK(line_count(ran.errors) == 1);
  CHECK_THAT(ran.errors, holds_text("gnuplot"));
  for (const fs::directory_entry& file : fs::directory_iterator(study.path() / "out/figures")) {
    CHECK(file.path().extension() != ".svg");
    CHECK(file.path().extension() != ".pdf");
  }
  CHECK(fs::exists(study.path() / "out/figures/confusion-and-accuracy.csv"));
  CHECK(fs::exists(study.path() / "out/figures/confusion-and-accuracy.gp"));
  const std::string page = content(study.path() / "out/report.html");
  CHECK_THAT(page, holds_text("SIMULATED"));
  CHECK_THAT(page, holds_text("figure-exploration-1-"));
  CHECK_THAT(page, !holds_text("<svg"));
  const ProgramResult json = study.type("report @s.db --json --cues yes");
  CHECK(content(study.path() / "out/results.json") == json.output);

  // The same report without cues has fewer tables: only these are removed.
  replace_file(study.path() / "out/tables/mine.md", std::string("mine"));
  REQUIRE(fs::exists(study.path() / "out/tables/cues-1.md"));
  std::vector<std::string> fewer = report;
  fewer.insert(fewer.end(), {"--cues", "no"});
  succeeded(without_gnuplot(study, fewer));
  CHECK_FALSE(fs::exists(study.path() / "out/tables/cues-1.md"));
  CHECK(content(study.path() / "out/tables/mine.md") == "mine");
}

TEST_CASE("report --out refuses a file, another study's folder, and a missing trial") {
  const StudyFolder study;
  succeeded(study.simulate("s.db"));
  replace_file(study.path() / "file", std::string("text"));
  fs::create_directory(study.path() / "other");
  replace_file(study.path() / "other/results.json", std::string(R"({"study": "leaves"})"));
  for (const std::string out : {"file", "other"}) {
    const ProgramResult ran = study.run({"report", study.in("s.db"), "--out", study.in(out)});
    INFO(ran.errors);
    CHECK(ran.exit_code == 1);
    CHECK(line_count(ran.errors) == 1);
  }
  CHECK_FALSE(fs::exists(study.path() / "other/report.html"));
  for (const std::string trial : {"P001", "P001:999", "nobody:1"}) {
    check_refused(
        study.run({"report", study.in("s.db"), "--out", study.in("out"), "--trial", trial}), 2, {});
  }
  CHECK_FALSE(fs::exists(study.path() / "out"));
}

TEST_CASE("report --out of a blind study reveals nothing about what was presented") {
  const StudyFolder study;
  succeeded(study.simulate("s.db", {"--keep-blind"}));
  study.done("report @s.db --out @out");
  const std::string all = texts_in(study.path() / "out");
  for (const std::string& label : kLabels) CHECK_THAT(all, !holds_text(label));
  CHECK_THAT(all, !holds_text("accuracy"));
  CHECK_FALSE(fs::exists(study.path() / "out/figures"));
  for (const std::vector<std::string>& asked :
       {std::vector<std::string>{"--trial", "P001:1"}, {"--cues", "yes"}}) {
    std::vector<std::string> words = {"report", study.in("s.db"), "--out", study.in("out")};
    words.insert(words.end(), asked.begin(), asked.end());
    CHECK(study.run(words).exit_code == 2);
  }
}
