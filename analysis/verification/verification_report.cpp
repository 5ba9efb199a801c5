#include "analysis/report/json_figures.hpp"
#include "analysis/report/text_figures.hpp"
#include "analysis/verification/verification.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace touchtrial::analysis {
namespace {

/// Lists the skipped checks, so that readers do not mistake them for passed checks.
std::string skipped_line(const Verification& verification) {
  std::vector<std::string> names;
  for (const Check& check : verification.checks) {
    if (check.state == CheckState::not_checked) names.push_back(check.name);
  }
  if (names.empty()) return "";
  return fmt::format("{} of {} checks not made: {}\n", names.size(), verification.checks.size(),
                     fmt::join(names, ", "));
}

}  // namespace

std::string verification_json(const Verification& verification) {
  nlohmann::ordered_json object;
  put_stamp(object, verification.simulated);
  object["holds"] = verification.holds();
  object["complete"] = verification.complete();
  object["head"] = nullptr;
  if (verification.head) {
    object["head"] = {{"length", verification.head->length},
                      {"hash", to_hex(verification.head->hash)}};
  }
  object["investigator"] = to_hex(verification.investigator);
  object["checks"] = nlohmann::ordered_json::array();
  for (const Check& check : verification.checks) {
    object["checks"].push_back(
        {{"name", check.name}, {"state", name_of(check.state)}, {"detail", check.detail}});
  }
  object["notes"] = verification.notes;
  return json_text(object);
}

std::string verification_text(const Verification& verification) {
  std::string text = simulated_line(verification.simulated);
  for (const Check& check : verification.checks) {
    text += fmt::format("{:<13}  {:<11}  {}\n", check.name, name_of(check.state), check.detail);
  }
  if (verification.head) {
    text += fmt::format("{:<13}  {} events, head {}\n", "file's chain", verification.head->length,
                        to_hex(verification.head->hash));
  }
  text += fmt::format("{:<13}  {}\n", "investigator", to_hex(verification.investigator));
  for (const std::string& note : verification.notes) text += fmt::format("note: {}\n", note);
  return text + skipped_line(verification);
}

}  // namespace touchtrial::analysis
