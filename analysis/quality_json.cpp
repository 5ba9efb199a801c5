#include "analysis/json_figures.hpp"
#include "analysis/quality.hpp"

#include <nlohmann/json.hpp>

namespace touchtrial {

nlohmann::ordered_json quality_object(const QualityReport& report) {
  const SessionCounts& sessions = report.sessions;
  const TrialQuality& quality = report.quality;
  nlohmann::ordered_json object{{"study", report.study}, {"protocol", report.protocol}};
  put_stamp(object, report.simulated);
  object["state"] = name_of(report.state);
  object["blinded"] = !report.state.unblinded;
  object["participants"] = report.participants;
  object["trials"] = report.trials;
  object["sessions"] = {{"completed", sessions.completed}, {"open", sessions.open},
                        {"stopped", sessions.stopped},     {"excluded", sessions.excluded},
                        {"withdrawn", sessions.withdrawn}, {"pilot", sessions.pilot}};
  object["responses"] = {
      {"presented", quality.presented},     {"answered", quality.answered},
      {"changed", quality.changed},         {"no_response", quality.no_response},
      {"interrupted", quality.interrupted}, {"by_position", quality.by_position}};
  object["validity"] = {
      {"trials", quality.with_trace},
      {"valid", quality.valid},
      {"share", figure_json(Proportion{quality.with_trace, quality.valid}.share())}};
  object["servo"] = {{"overruns", quality.overruns},
                     {"trials_with_overruns", quality.with_overruns},
                     {"lowest_rate_hz", figure_json(quality.lowest_rate_hz)}};
  return object;
}

std::string quality_json(const QualityReport& report) {
  return json_text(quality_object(report));
}

}  // namespace touchtrial
