#include "analysis/json_figures.hpp"
#include "analysis/report/quality.hpp"

#include <nlohmann/json.hpp>

namespace touchtrial::analysis {
namespace {

void put_real_time(nlohmann::ordered_json& object, const ServoQuality& servo) {
  object["trials_in_real_time"] = servo.trials;
  object["lowest_rate_had_hz"] = servo.lowest_rate_hz;
  object["lateness_us"] = {{"median_p99", servo.median_p99_us},
                           {"highest_p99", servo.highest_p99_us},
                           {"worst", servo.worst_us}};
  object["lost_samples"] = servo.lost;
  object["scheduling"] = servo.scheduling;
}

}  // namespace

nlohmann::ordered_json quality_object(const QualityReport& report) {
  const SessionCounts& sessions = report.sessions;
  const TrialQuality& quality = report.quality;
  nlohmann::ordered_json object{{"study", report.study}, {"protocol", report.protocol}};
  put_stamp(object, report.simulated);
  put_state(object, report.state, report.pilot);
  object["blinded"] = !report.state.unblinded;
  object["participants"] = report.participants;
  object["trials"] = report.trials;
  object["sessions"] = {{"completed", sessions.completed}, {"open", sessions.open},
                        {"stopped", sessions.stopped},     {"excluded", sessions.excluded},
                        {"replaced", sessions.replaced},   {"withdrawn", sessions.withdrawn},
                        {"pilot", sessions.pilot}};
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
  if (report.servo) put_real_time(object["servo"], *report.servo);
  if (report.visual) object["visual"] = true;
  object["collection"] = collection_object(report.collection);
  return object;
}

std::string quality_json(const QualityReport& report) {
  return json_text(quality_object(report));
}

}  // namespace touchtrial::analysis
