#include "analysis/confusion.hpp"
#include "analysis/quality.hpp"
#include "analysis/text_figures.hpp"
#include "analysis/text_table.hpp"

#include <fmt/format.h>

namespace touchtrial {
namespace {

std::string sessions_text(const QualityReport& report) {
  TextTable table({"sessions", "completed", "open", "stopped", "excluded", "withdrawn", "pilot"});
  const SessionCounts& counts = report.sessions;
  table.add({"", std::to_string(counts.completed), std::to_string(counts.open),
             std::to_string(counts.stopped), std::to_string(counts.excluded),
             std::to_string(counts.withdrawn), std::to_string(counts.pilot)});
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
    text += fmt::format(", lowest mean rate {:.1f} Hz", *quality.lowest_rate_hz);
  }
  return text + '\n';
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
  text += sessions_text(report) + health_text(report) + positions_text(report);
  if (report.simulated) text += '\n' + simulated_line(report.simulated);
  return text;
}

}  // namespace touchtrial
