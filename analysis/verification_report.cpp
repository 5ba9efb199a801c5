#include "analysis/json_figures.hpp"
#include "analysis/text_figures.hpp"
#include "analysis/verification.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial {

std::string verification_json(const Verification& verification) {
  nlohmann::ordered_json object;
  put_stamp(object, verification.simulated);
  object["holds"] = verification.holds();
  object["checks"] = nlohmann::ordered_json::array();
  for (const Check& check : verification.checks) {
    object["checks"].push_back(
        {{"name", check.name}, {"state", name_of(check.state)}, {"detail", check.detail}});
  }
  return json_text(object);
}

std::string verification_text(const Verification& verification) {
  std::string text = simulated_line(verification.simulated);
  for (const Check& check : verification.checks) {
    text += fmt::format("{:<13}  {:<11}  {}\n", check.name, name_of(check.state), check.detail);
  }
  return text;
}

}  // namespace touchtrial
