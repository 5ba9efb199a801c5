#include "analysis/report/quality.hpp"
#include "analysis/statistics/confusion.hpp"
#include "analysis/text_figures.hpp"
#include "analysis/text_table.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

std::string sessions_text(const QualityReport& report) {
  TextTable table(
      {"sessions", "completed", "open", "stopped", "excluded", "replaced", "withdrawn", "pilot"});
  const SessionCounts& counts = report.sessions;
  table.add({"", std::to_string(counts.completed), std::to_string(counts.open),
             std::to_string(counts.stopped), std::to_string(counts.excluded),
             std::to_string(counts.replaced), std::to_string(counts.withdrawn),
             std::to_string(counts.pilot)});
  return heading("sessions", report.simulated) + table.text();
}

std::string positions_text(const QualityReport& report) {
  std::vector<std::string> header{"position"};
  std::vector<std::string> answers{"answers"};
  std::vector<std::string> shares{"share"};
  const TrialQuality& quality = report.quality;
  for (std::size_t i = 0; i < quality.by_position.size(); ++i) {
    header.push_back(std::to_string(i + 1));
    answers.push_back(std::to_string(quality.by_position[i]));
    shares.push_back(percent(percentage(quality.by_position[i], quality.answered), 1));
  }
  TextTable table(header);
  table.add(answers);
  table.add(shares);
  return heading("answers by the picture's position", report.simulated) + table.text();
}

std::string health_text(const QualityReport& report) {
  const TrialQuality& quality = report.quality;
  std::string text = heading("trials", report.simulated);
  text += fmt::format("  presented {}, answered {} ({} changed), no response {}, interrupted {}\n",
                      quality.presented, quality.answered, quality.changed, quality.no_response,
                      quality.interrupted);
  text += fmt::format("  valid {} of {} with a trace ({})\n", quality.valid, quality.with_trace,
                      percent_of({quality.with_trace, quality.valid}));
  text += fmt::format("  servo overruns {} in {}", quality.overruns,
                      counted(quality.with_overruns, "trial"));
  if (quality.lowest_rate_hz) {
    text += fmt::format(", lowest rate of a trace {:.1f} Hz", *quality.lowest_rate_hz);
  }
  return text + '\n';
}

/// A lateness, which may be microseconds or a second.
std::string microseconds(double time_us) {
  return fmt::format("{:.{}f} us", time_us, time_us < 10.0 ? 1 : 0);
}

std::string servo_text(const QualityReport& report) {
  const ServoQuality& servo = *report.servo;
  TextTable table({"servo", "trials", "lowest had rate", "late p99", "highest p99", "worst",
                   "overruns", "lost"});
  table.add({"", std::to_string(servo.trials), fmt::format("{:.1f} Hz", servo.lowest_rate_hz),
             microseconds(servo.median_p99_us), microseconds(servo.highest_p99_us),
             microseconds(servo.worst_us), std::to_string(report.quality.overruns),
             std::to_string(servo.lost)});
  std::string text = heading("servo in real time", report.simulated) + table.text();
  for (const std::string& had : servo.scheduling) text += "  scheduling: " + had + '\n';
  return text;
}

}  // namespace

std::string quality_text(const QualityReport& report) {
  std::string text = simulated_line(report.simulated);
  text += fmt::format("{} ({}): {}, {}; {}\n", report.study, report.protocol,
                      counted(report.participants, "participant"), counted(report.trials, "trial"),
                      name_of(report.state));
  if (!report.state.unblinded) {
    text += wrapped("", "Blinded: outcomes are shown once the study has been unblinded.");
  }
  if (report.pilot) text += wrapped("", "PILOT: not to be pooled with the study's data.");
  if (report.visual) {
    text += wrapped("", "Seen on a screen, not felt: never to be pooled with what was felt.");
  }
  text += sessions_text(report) + health_text(report);
  if (report.servo) text += servo_text(report);
  text += positions_text(report);
  if (report.simulated) text += '\n' + simulated_line(report.simulated);
  return text;
}

}  // namespace touchtrial::analysis
