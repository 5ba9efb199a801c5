// procedure: replays a list of answers through an adaptive track of a study.
#include "analysis/planning/planner.hpp"
#include "app/commands/commands.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/strict_json.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::app {
namespace {

struct ProcedureArguments {
  std::filesystem::path study;
  std::string answers;
  int track = 1;
  bool json = true;
};

/// Parses answers such as "1,0,1"; an empty text contains none.
/// \throws UsageError if a part is neither 0 nor 1
std::vector<bool> parse_answers(std::string_view text) {
  std::vector<bool> answers;
  for (std::size_t begin = 0; !text.empty() && begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view part = text.substr(begin, end - begin);
    if (part != "0" && part != "1") {
      throw UsageError("--answers: " + in_quotes(part) +
                       " is not an answer; give 1 for right and 0 for wrong, for instance 1,0,1");
    }
    answers.push_back(part == "1");
    begin = end + 1;
  }
  return answers;
}

int show_procedure(const ProcedureArguments& arguments) {
  const std::vector<bool> answers = parse_answers(arguments.answers);
  const study::Study study = study::load_study(arguments.study);
  print(planning::planner_of(study, "`procedure`").procedure(study, arguments.track, answers));
  return 0;
}

}  // namespace

void add_procedure_command(CLI::App& program, Action& action) {
  const auto [command, arguments] = add_command(
      program, action, "procedure",
      "Replay answers through one adaptive track; print its levels and posterior as JSON",
      show_procedure);
  add_study_argument(command, arguments.study);
  command
      .add_option("--answers", arguments.answers,
                  "1 for right, 0 for wrong; empty: only the first level")
      ->type_name("1,0,1..")
      ->required();
  command.add_option("--track", arguments.track, "Number of the track")->capture_default_str();
  command.add_flag("--json", arguments.json, "The output is always JSON");
}

}  // namespace touchtrial::app
