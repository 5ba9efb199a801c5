#include "analysis/report/text_figures.hpp"

#include <string_view>

#include <fmt/format.h>

namespace touchtrial::analysis {

std::string p_value(double p) {
  // Rounds halves up, so that 0.03125 is not shown as a smaller p.
  return fmt::format("{:.3g}", p * (1.0 + 1e-9));
}

void add_people(int people, const char* words, std::vector<std::string>& all) {
  if (people > 0) all.push_back(fmt::format("{} {}", people, words));
}

std::string heading(const std::string& title, bool simulated) {
  return fmt::format("\n{}{}\n", title, simulated ? " [SIMULATED]" : "");
}

namespace {

std::string single_device_words(const std::string& recorded) {
  constexpr std::string_view kSimulated = "simulated ";
  if (recorded == "simulated") return "ideal device (no such device is sold)";
  if (recorded == "given-function") return "no device (answers follow a given function)";
  if (recorded == kStatedPeople) return "no device (people's accuracies are stated)";
  return recorded.starts_with(kSimulated) ? "modelled device " + recorded.substr(kSimulated.size())
                                          : recorded;
}

}  // namespace

std::string device_words(const std::set<std::string>& recorded) {
  std::string words;
  for (const std::string& device : recorded) {
    words += (words.empty() ? "" : "; ") + single_device_words(device);
  }
  return words;
}

std::string simulated_on(const std::string& device) {
  return device.empty() ? "" : "simulated on: " + device;
}

std::string simulated_on_line(const std::string& device) {
  return device.empty() ? "" : simulated_on(device) + "\n";
}

std::string simulated_line(bool simulated) {
  return simulated ? "SIMULATED: these numbers come from simulated participants.\n" : "";
}

}  // namespace touchtrial::analysis
