// A machine with out of memory: one line, and nothing half made.
#include "app/study_folder.hpp"
#include "support/catch.hpp"
#include "support/sanitized.hpp"

#include <string>
#include <vector>

using namespace touchtrial;

namespace {

constexpr int kNotLoaded = 127;  // the system's loader found no room for a library
constexpr int kFirstKib = 40 * 1024;
constexpr int kEnoughKib = 600 * 1024;

}  // namespace

TEST_CASE("whatever memory is missing, a command ends with one line and leaves nothing half made") {
  if (kSanitized) return;  // sanitizers reserve more address space than there is
  const StudyFolder study;
  succeeded(study.simulate("s.db"));
  struct Command {
    std::string line;
    std::string made;
    int step_kib;
  };
  const std::vector<Command> commands = {
      // Fine steps find the lack of memory in every step of the work. A report takes ten times as
      // much, and a second for each.
      {"extract @granite-photo.png --control phase-scrambled -o @made.png", "made.png", 256},
      {"simulate @cloths.json --participants 2 --subject @quick.json --db @made.db", "made.db",
       1024},
      {"report @s.db --out @made", "made/report.html", 12 * 1024},
      {"export @s.db --out @tables", "", 1024}};
  int refused = 0;
  for (const Command& command : commands) {
    bool is_enough = false;
    for (int kib = kFirstKib; !is_enough && kib < kEnoughKib; kib += command.step_kib) {
      const ProgramResult result = run_touchtrial_limited(study.path(), "-v " + std::to_string(kib),
                                                          typed_words(command.line, study.path()));
      INFO(command.line << " with " << kib << " KiB: " << result.errors);
      if (result.exit_code == kNotLoaded) continue;
      is_enough = result.exit_code == 0;
      if (is_enough) break;
      ++refused;
      CHECK(result.exit_code == 1);
      CHECK(line_count(result.errors) == 1);
      if (!command.made.empty()) CHECK_FALSE(path_exists(study.path() / command.made));
      for (const auto& entry : fs::directory_iterator(study.path())) {
        CHECK_FALSE(entry.path().extension() == ".tmp");
      }
    }
    INFO(command.line);
    CHECK(is_enough);
  }
  CHECK(refused > 0);
}
