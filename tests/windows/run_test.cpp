// "touchtrial run" as experimenter and participant have it, on a screen that nobody sees.
#include "app/touchtrial_process.hpp"
#include "core/files.hpp"
#include "protocols/store/study_store.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"
#include "windows/virtual_screen.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

namespace touchtrial {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// The default study of 25 trials, without questions and practice, and a quick subject.
struct Laboratory {
  Laboratory() {
    const fs::path source = TOUCHTRIAL_SOURCE_DIR;
    fs::create_directory(folder.path() / "config");
    fs::copy(source / "stimuli", folder.path() / "stimuli", fs::copy_options::recursive);
    json study = json::parse(text_of(read_file(source / "config/classification.json", 1U << 20U)));
    study["trials"]["practice"] = 0;
    study["trials"]["break_every"] = 0;
    study.erase("practice");
    study["session"] = {{"handedness", false}, {"closing", false}};
    replace_file(in("config/study.json"), study.dump());
    replace_file(in("quick.json"), R"({"explore_s": 1.0, "training_passes": 2})");
    REQUIRE(run_touchtrial(folder.path(), {"prepare", in("config/study.json")}).exit_code == 0);
  }

  [[nodiscard]] std::string in(const std::string& name) const {
    return (folder.path() / name).string();
  }
  [[nodiscard]] std::vector<std::string> run_arguments(const std::string& database,
                                                       const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {
        "run", in("config/study.json"), "--participant", "P01", "--db", in(database), "--no-sound"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  void verify(const std::string& database) const {
    const ProgramResult verified =
        run_touchtrial(folder.path(), {"verify", in(database), "--key", in("config/study.key")});
    INFO(verified.output << verified.errors);
    CHECK(verified.exit_code == 0);
  }

  TempFolder folder;
};

std::vector<store::TrialRow> trials_in(const std::string& database) {
  return store::StudyStore::open(database, store::StudyStore::Access::read_only).trials();
}

std::vector<int> positions_of(const std::vector<store::TrialRow>& trials) {
  std::vector<int> positions;
  for (const store::TrialRow& trial : trials) positions.push_back(trial.position.value_or(-1));
  return positions;
}

std::vector<int> positions_as_answered(const std::string& database) {
  std::vector<store::TrialRow> trials = trials_in(database);
  std::ranges::sort(trials, {}, &store::TrialRow::answered_at);
  return positions_of(trials);
}

TEST_CASE("a simulated participant answers with the window's keys as without a window") {
  const auto screen = VirtualScreen::open("1280x720");
  const Laboratory lab;
  const std::vector<std::string> subject = {"--subject", lab.in("quick.json"), "--seed", "4"};
  std::vector<std::string> headless = subject;
  headless.push_back("--headless");
  REQUIRE(run_touchtrial(lab.folder.path(), lab.run_arguments("a.db", headless)).exit_code == 0);
  const ProgramResult seen = run_touchtrial(lab.folder.path(), lab.run_arguments("b.db", subject));
  INFO(seen.errors);
  REQUIRE(seen.exit_code == 0);
  CHECK(seen.output.find("trial 25 acknowledged\n") != std::string::npos);
  const std::vector<int> answers = positions_of(trials_in(lab.in("b.db")));
  CHECK(answers.size() == 25);
  CHECK(answers == positions_of(trials_in(lab.in("a.db"))));
  lab.verify("b.db");
}

/// A person with a keyboard, who looks at what the experimenter's status says. Its "trial" counts
/// presentations: one in which a busy machine let the servo stand still is spoilt, and its stimulus
/// comes again under a later number.
class Pilot {
 public:
  Pilot(const Laboratory& lab, const VirtualScreen& screen)
      : screen_(screen),
        log_(lab.in("log")),
        arguments_(lab.run_arguments("pilot.db",
                                     {"--device", "mouse", "--pilot", "--window", "1280x720"})) {}

  /// \return the program's exit code
  int sit_through() {
    child_ = ::fork();
    if (child_ == 0) become_program();
    int status = 0;
    while (::waitpid(child_, &status, WNOHANG) == 0) {
      react();
      std::this_thread::sleep_for(std::chrono::milliseconds(60));
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  [[nodiscard]] std::vector<int> meant() const {
    std::vector<int> positions;
    for (const auto& [presentation, position] : meant_) positions.push_back(position);
    return positions;
  }

 private:
  [[noreturn]] void become_program() const {
    std::vector<char*> arguments = {const_cast<char*>(TOUCHTRIAL_PROGRAM)};
    for (const std::string& one : arguments_) arguments.push_back(const_cast<char*>(one.c_str()));
    arguments.push_back(nullptr);
    if (std::freopen("/dev/null", "r", stdin) == nullptr ||
        std::freopen(log_.c_str(), "w", stderr) == nullptr ||
        std::freopen("/dev/null", "w", stdout) == nullptr) {
      ::_exit(98);
    }
    ::execv(TOUCHTRIAL_PROGRAM, arguments.data());
    ::_exit(99);
  }

  /// "P01  answering  trial 3 of 25 .."
  void react() {
    const std::string line = last_line();
    const bool answering = line.find("  answering  ") != std::string::npos;
    const std::size_t at = line.find("  trial ");
    if (line.rfind("P01  ", 0) != 0) return;
    if (answering && at != std::string::npos) {
      const int presentation = std::atoi(line.c_str() + at + 8);
      meant_[presentation] = presentation % 5;
      screen_.type(std::to_string(presentation % 5 + 1));
    }
    screen_.type("Return");
  }

  /// That has been written to its end.
  [[nodiscard]] std::string last_line() const {
    if (!fs::exists(log_)) return "";
    std::string text = text_of(read_file(log_, 1U << 24U));
    text.erase(text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n'));
    return text.substr(text.rfind('\n') + 1);
  }

  const VirtualScreen& screen_;
  std::string log_;
  std::vector<std::string> arguments_;
  std::map<int, int> meant_;  ///< position by presentation that was answered
  pid_t child_ = -1;
};

TEST_CASE("a person pilots a whole session of 25 trials from the keyboard") {
  const auto screen = VirtualScreen::open("1280x720");
  const Laboratory lab;
  Pilot pilot(lab, *screen);
  REQUIRE(pilot.sit_through() == 0);
  CHECK(pilot.meant().size() == 25);
  CHECK(positions_as_answered(lab.in("pilot.db")) == pilot.meant());
  lab.verify("pilot.db");
}

}  // namespace
}  // namespace touchtrial
