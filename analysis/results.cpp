#include "analysis/results.hpp"

#include "core/errors.hpp"
#include "protocols/design/protocol.hpp"

#include <map>

namespace touchtrial::analysis {
namespace {

std::map<std::string_view, const ProtocolAnalysis*>& known_analyses() {
  static std::map<std::string_view, const ProtocolAnalysis*> all;
  return all;
}

}  // namespace

std::vector<Figure> Results::figures(const std::string&) const {
  return {};
}

std::vector<ResultTable> ProtocolAnalysis::tables(const Outcomes&) const {
  return {};
}

std::vector<std::filesystem::path> ProtocolAnalysis::export_model(
    const store::StudyStore&, const Outcomes& outcomes, const std::filesystem::path&) const {
  throw UsageError("--format r: the protocol " + outcomes.design.protocol_name() +
                   " has no model for R; choose csv, json, bids or psych-ds");
}

void add_analysis(std::string_view protocol, const ProtocolAnalysis& analysis) {
  known_analyses()[protocol] = &analysis;
}

const ProtocolAnalysis& analysis_of(const design::Study& study) {
  const auto found = known_analyses().find(study.protocol->name());
  if (found != known_analyses().end()) return *found->second;
  throw StudyError(one_line("study " + study.name + ": the protocol " + study.protocol_name() +
                            " has no report; export the trials instead"));
}

}  // namespace touchtrial::analysis
