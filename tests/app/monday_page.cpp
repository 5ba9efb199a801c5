#include "app/monday_page.hpp"

#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/child_process.hpp"

#include <sstream>

#include <fmt/format.h>

namespace touchtrial {
namespace {

std::string replaced(std::string text, const std::string& old, const std::string& with) {
  for (std::size_t at = text.find(old); at != std::string::npos;
       at = text.find(old, at + with.size())) {
    text.replace(at, old.size(), with);
  }
  return text;
}

void make_program(const fs::path& path, const std::string& script) {
  replace_file(path, "#!/bin/sh\n" + script);
  fs::permissions(path, fs::perms::owner_all);
}

}  // namespace

std::map<std::string, MondayCase> monday_cases() {
  std::istringstream page(content(fs::path(TOUCHTRIAL_SOURCE_DIR) / "docs" / "monday-morning.md"));
  std::map<std::string, MondayCase> cases;
  std::string heading;
  bool in_block = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("```")) {
      in_block = line.size() > 3;
      if (in_block) cases[heading].blocks.emplace_back();
    } else if (line.starts_with("## ")) {
      heading = line.substr(3);
      cases[heading] = {};
    } else if (!line.empty()) {
      ++cases[heading].lines;
      if (in_block) cases[heading].blocks.back().push_back(line);
    }
  }
  return cases;
}

std::vector<std::string> monday_block(const std::string& heading, std::size_t block) {
  const std::map<std::string, MondayCase> cases = monday_cases();
  INFO(heading << ", block " << block);
  REQUIRE(cases.contains(heading));
  REQUIRE(block < cases.at(heading).blocks.size());
  return cases.at(heading).blocks[block];
}

MondayDesk::MondayDesk() {
  for (const char* const name :
       {"home/study", "home/investigator", "media/stick", "media/backup", "bin"}) {
    fs::create_directories(root() / name);
  }
  go_to(study());
  json document = study_of("classification");
  document["trials"]["repeats"] = 6;
  document["trials"]["explore_limit_s"] = 1.0;
  document["trials"]["validity"] = {{"exploring_s", 1.0}, {"contact_s", 1.0}, {"path_mm", 100.0}};
  for (std::size_t i = 0; i < kLabels.size(); ++i) {
    engine::write_png(study() / (kLabels[i] + "-photo.png"), texture_number(static_cast<int>(i)));
  }
  replace_file(study() / "study.json", document.dump());
  replace_file(root() / "quick.json",
               R"({"feature_noise": 0.1, "explore_s": 0.5, "training_passes": 2})");
  // `run` has a participant, who takes as long as a person would if the desk asks for that; nobody
  // is there whom `withdraw` could ask.
  make_program(
      root() / "bin" / "touchtrial",
      fmt::format("if [ -f {0}/clock ]; then export FAKE_CLOCK_AHEAD_S=$(cat {0}/clock); fi\n"
                  "if [ -f {0}/disk ]; then export FAKE_DISK_BYTES=$(cat {0}/disk); fi\n"
                  "if [ \"$1\" = run ]; then\n"
                  "  set -- \"$@\" --subject {0}/quick.json --headless $PACE\n"
                  "fi\n"
                  "if [ \"$1\" = withdraw ]; then set -- \"$@\" --yes; fi\n"
                  "export LD_PRELOAD={1}\n"
                  "exec {2} \"$@\"\n",
                  root().string(), TOUCHTRIAL_FAKE_MACHINE, TOUCHTRIAL_PROGRAM));
  make_program(root() / "bin" / "sudo",
               fmt::format("test \"$1\" = date && rm {}/clock\n", root().string()));
  type_all({"touchtrial prepare study.json", "cp -a . ../investigator", "rm study.key",
            "rm ../investigator/study.station"});
}

std::string MondayDesk::script(const std::string& command) const {
  return fmt::format(
             "export HOME='{0}/home' PATH='{0}/bin':\"$PATH\" "
             "ASAN_OPTIONS=\"$ASAN_OPTIONS:verify_asan_link_order=0\"\ncd '{1}' && ",
             root().string(), here_.string()) +
         replaced(command, "/media/", (root() / "media").string() + "/");
}

ProgramResult MondayDesk::type(const std::string& command, const std::string& input) {
  // What the shell was left in is where the next command is typed.
  const std::string where = (root() / "here.txt").string();
  const ProgramResult result = run_program(
      "/bin/sh", root(),
      {"-c", fmt::format("{}\nstatus=$?\npwd > '{}'\nexit $status", script(command), where)},
      input);
  std::string here = content(where);
  here.pop_back();
  here_ = here;
  return result;
}

ProgramResult MondayDesk::type_all(const std::vector<std::string>& commands) {
  ProgramResult last;
  for (const std::string& command : commands) {
    last = type(command);
    INFO(command << "\n" << last.output << last.errors);
    REQUIRE(last.exit_code == 0);
  }
  return last;
}

void MondayDesk::complete(const std::string& participant) {
  const ProgramResult result = type("touchtrial run study.json --participant " + participant +
                                    " --db study.db --heads /media/stick");
  INFO(result.output << result.errors);
  REQUIRE(result.exit_code == 0);
}

std::string MondayDesk::break_off(const std::string& participant, int trial, int signal) {
  testing::ChildProcess program(
      {"/bin/sh", "-c",
       script("exec env PACE=--real-time touchtrial run study.json --participant " + participant +
              " --db study.db --heads /media/stick")},
      {});
  const bool came_there = program.says(fmt::format("trial {} acknowledged\n", trial));
  program.send_signal(signal);
  static_cast<void>(program.finish());
  INFO(program.output());
  REQUIRE(came_there);
  return program.output();
}

void MondayDesk::set_clock_ahead(long seconds) {
  replace_file(root() / "clock", std::to_string(seconds));
}

void MondayDesk::fill_disk_after(long bytes) {
  if (bytes == 0) {
    fs::remove(root() / "disk");
  } else {
    replace_file(root() / "disk", std::to_string(bytes));
  }
}

}  // namespace touchtrial
