#include "protocols/identification/analysis/hierarchical_choice.hpp"

#include "analysis/json_figures.hpp"
#include "core/errors.hpp"
#include "core/text.hpp"
#include "protocols/identification/analysis/counted_trials.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::analysis::identification {
namespace {

using Json = nlohmann::ordered_json;

/// "1 bark, 2 cloth", on one line.
std::string numbered(const std::vector<std::string>& labels) {
  int number = 0;
  return listed(labels, ", ", [&number](const std::string& label) {
    return fmt::format("{} {}", ++number, one_line(label));
  });
}

ConfusionMatrix answers_of(int classes, const OwnTrials& trials) {
  ConfusionMatrix answers(classes);
  for (const TrialOutcome* trial : trials) answers.add(choice_of(*trial));
  return answers;
}

}  // namespace

std::string choice_model_script(const Outcomes& outcomes) {
  return fmt::format(
             "// Hierarchical choice model of the study {}{}. Data: choice_model.json. How to run "
             "it: "
             "mixed_model.md.\n// Classes: {}.\n// Methods: {}.\n\n",
             one_line(outcomes.study), outcomes.simulated ? " (SIMULATED)" : "",
             numbered(outcomes.classes), numbered(outcomes.methods)) +
         std::string(choice_model_program());
}

std::string choice_model_data(const Outcomes& outcomes) {
  const CountedTrials counted = counted_by_method(outcomes);
  const auto classes = static_cast<int>(outcomes.classes.size());
  Json counts = Json::array();
  Json felt = Json::array();
  for (std::size_t method = 0; method < counted.trials.size(); ++method) {
    for (const OwnTrials& trials : counted.trials[method]) {
      const ConfusionMatrix answers = answers_of(classes, trials);
      if (answers.answered() == 0) continue;
      for (int i = 0; i < classes; ++i) {
        Json row = Json::array();
        for (int j = 0; j < classes; ++j) row.push_back(answers.count(i, j));
        counts.push_back(std::move(row));
      }
      Json of_method = Json::array();
      for (std::size_t m = 0; m < counted.trials.size(); ++m) {
        of_method.push_back(m == method ? 1 : 0);
      }
      felt.push_back(std::move(of_method));
    }
  }
  const std::size_t rows = felt.size();
  return json_text({{"K", classes},
                    {"J", rows},
                    {"M", counted.trials.size()},
                    {"counts", std::move(counts)},
                    {"felt", std::move(felt)}});
}

}  // namespace touchtrial::analysis::identification
