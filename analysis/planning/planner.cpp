#include "analysis/planning/planner.hpp"

#include "core/errors.hpp"
#include "study/protocol.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

namespace touchtrial::planning {
namespace {

std::map<std::string_view, const Planner*>& registered_planners() {
  static std::map<std::string_view, const Planner*> all;
  return all;
}

/// Names a protocol with tracks and its shipped study: "the protocol NAME, such as FILE".
std::string words_of_tracks() {
  for (const auto& [protocol, planner] : registered_planners()) {
    if (planner->study_with_tracks().empty()) continue;
    return fmt::format("the protocol {}, such as {}", protocol, planner->study_with_tracks());
  }
  return "another protocol";
}

}  // namespace

std::string_view Planner::study_with_tracks() const {
  return {};
}

std::string Planner::procedure(const study::Study& study, int, const std::vector<bool>&) const {
  throw UsageError(one_line(fmt::format(
      "{}: the protocol {} has no adaptive procedure; `touchtrial procedure` needs a study of {}",
      study.source, study.protocol_name(), words_of_tracks())));
}

std::vector<std::pair<std::string, double>> Planner::pilot_thresholds(
    const analysis::Outcomes&, const std::string& place) const {
  throw StudyError(
      one_line(place + ": is not a detection study along gain with the task \"which interval\""));
}

void add_planner(std::string_view protocol, const Planner& planner) {
  registered_planners()[protocol] = &planner;
}

const Planner& planner_of(const study::Study& study, const std::string& what) {
  const auto found = registered_planners().find(study.protocol->name);
  if (found != registered_planners().end()) return *found->second;
  throw StudyError(one_line("study " + study.name + ": the protocol " + study.protocol_name() +
                            " has no " + what + "; give a study of another"));
}

std::vector<std::string_view> protocols_with(std::string_view option) {
  std::vector<std::string_view> found;
  for (const auto& [protocol, planner] : registered_planners()) {
    const auto options = planner->options();
    if (std::ranges::find(options, option) != options.end()) found.push_back(protocol);
  }
  return found;
}

}  // namespace touchtrial::planning
