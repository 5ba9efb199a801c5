#include "analysis/page/frame_sections.hpp"

#include "analysis/collection_records.hpp"
#include "analysis/page/wording.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/text_figures.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

const char* words_of(store::SessionState state) {
  switch (state) {
    case store::SessionState::open:
      return "open";
    case store::SessionState::completed:
      return "completed";
    case store::SessionState::stopped:
      return "stopped";
  }
  return "";
}

void add_leaving(int n, const std::string& why, FlowStep& step) {
  if (n > 0) step.leaving.push_back(fmt::format("{} {}", n, why));
}

/// Adds a line like "2 excluded: moved the device; fell asleep". A reason that was given several
/// times is followed by its count.
void add_excluded(const ParticipantFlow& flow, FlowStep& step) {
  if (flow.excluded == 0) return;
  std::map<std::string, int> reasons;
  for (const std::string& reason : flow.exclusion_reasons) ++reasons[reason];
  std::string text = fmt::format("{} excluded", flow.excluded);
  const char* separator = ": ";
  for (const auto& [reason, n] : reasons) {
    text += separator + reason + (n > 1 ? fmt::format(" ({})", n) : "");
    separator = "; ";
  }
  step.leaving.push_back(text);
}

Flow flow_of(const ParticipantFlow& flow) {
  FlowStep enrolled{counted(flow.enrolled, "participant") + " enrolled"};
  add_leaving(flow.erased, "withdrew; the keys of their sealed data were destroyed", enrolled);
  add_leaving(flow.replaced, "replaced by somebody else", enrolled);
  add_excluded(flow, enrolled);
  add_leaving(flow.stopped, "stopped before the end", enrolled);
  add_leaving(flow.open, "not ended yet", enrolled);
  add_leaving(flow.other_kind, "pilots or simulations among others", enrolled);
  add_leaving(flow.unseen, "ended after the interim look", enrolled);
  return {"flow",
          "Participants from enrolment to analysis, each counted once, by the session that was "
          "not replaced",
          {enrolled, {counted(flow.analysed, "participant") + " analysed"}}};
}

std::string devices_of(const std::vector<SessionRecord>& sessions) {
  std::map<std::string, int> devices;
  for (const SessionRecord& one : sessions) {
    if (one.row.erased) continue;
    std::string name = one.row.device;
    if (one.station && !one.station->model.empty()) name += ", " + one.station->model;
    if (!one.device_serial.empty()) name += ", serial " + one.device_serial;
    if (one.station && !one.station->firmware.empty())
      name += ", firmware " + one.station->firmware;
    if (one.station) {
      name += one.station->calibration.empty()
                  ? ", without a calibration certificate"
                  : ", certificate " + one.station->calibration.substr(0, 12);
    }
    ++devices[name];
  }
  std::string text;
  for (const auto& [name, n] : devices) {
    text += (text.empty() ? "" : "; ") + name + " (" + counted(n, "session") + ")";
  }
  return text;
}

std::string timeout_words(const std::string& on_timeout) {
  return on_timeout.empty() ? "" : ", then: " + on_timeout;
}

Definitions conditions_of(const Collection& collection) {
  const Prescription& rule = collection.prescription;
  Definitions definitions;
  auto& entries = definitions.entries;
  entries.emplace_back("sessions", std::to_string(collection.sessions.size()));
  entries.emplace_back("order", fmt::format("{}, {} of each stimulus", rule.order,
                                            counted(rule.repeats, "presentation")));
  entries.emplace_back("exploration",
                       rule.explore_limit_s > 0.0
                           ? fmt::format("at most {} s{}", plain_figure(rule.explore_limit_s, 0),
                                         timeout_words(rule.on_timeout))
                           : "without a limit");
  if (!rule.sight.empty()) entries.emplace_back("vision kept out by", rule.sight);
  entries.emplace_back("masking noise", rule.masking_wanted
                                            ? plain_figure(rule.masking_dbfs, 0) + " dBFS"
                                            : "not prescribed");
  const std::string devices = devices_of(collection.sessions);
  if (!devices.empty()) entries.emplace_back("device", devices);
  return definitions;
}

/// Each deviation with the participants in whose sessions it occurred.
std::optional<Table> deviations_table(const std::vector<SessionRecord>& sessions) {
  std::map<std::pair<std::string, std::string>, std::set<std::string>> found;
  for (const SessionRecord& one : sessions) {
    for (const Deviation& deviation : one.deviations) {
      found[{deviation.code, deviation.text}].insert(one.row.participant);
    }
  }
  if (found.empty()) return {};
  Table table{
      "deviations",
      "Deviations from the protocol",
      {{"code", Align::left}, {"what", Align::left}, {"participants"}, {"whose", Align::left}}};
  constexpr std::size_t kNamed = 10;
  for (const auto& [deviation, whose] : found) {
    std::vector<std::string> names(whose.begin(), whose.end());
    const bool many = names.size() > kNamed;
    if (many) names.resize(kNamed);
    table.rows.push_back({deviation.first, deviation.second.empty() ? kNoFigure : deviation.second,
                          std::to_string(whose.size()),
                          listed(names, " and ") + (many ? " …" : "")});
  }
  return table;
}

std::string remark_of(const SessionRecord& one) {
  std::vector<std::string> parts;
  if (!one.exclusion_reason.empty()) parts.push_back("excluded: " + one.exclusion_reason);
  if (!one.row.replaced_by.empty()) {
    parts.push_back("replaced by " + one.row.replaced_by +
                    (one.replacement_reason.empty() ? "" : ": " + one.replacement_reason));
  }
  if (!one.stop_reason.empty()) parts.push_back("stopped: " + one.stop_reason);
  if (one.row.withdrawn) {
    parts.push_back("withdrew, data kept" +
                    (one.withdrawal_reason.empty() ? "" : ": " + one.withdrawal_reason));
  }
  if (one.resumed > 0) parts.push_back("resumed " + counted(one.resumed, "time"));
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : "; ") + part;
  return text.empty() ? kNoFigure : text;
}

std::string practice_of(const SessionRecord& one) {
  if (!one.practice) return kNoFigure;
  const std::string correct =
      one.practice->correct ? fmt::format("{} of ", *one.practice->correct) : "";
  return fmt::format("{}{} in {}{}", correct, one.practice->presentations,
                     counted(one.practice->rounds, "round"),
                     one.practice->passed ? "" : ", not passed");
}

/// Tells whether the table of sessions has more to say about a session than that it was completed.
bool is_remarkable(const SessionRecord& one) {
  return one.row.withdrawn || one.row.excluded || one.row.state != store::SessionState::completed ||
         one.resumed > 0 || !one.row.replaced_by.empty() || one.practice.has_value();
}

std::optional<Table> sessions_table(const std::vector<SessionRecord>& sessions) {
  if (std::none_of(sessions.begin(), sessions.end(), is_remarkable)) return {};
  Table table{"sessions",
              "Sessions with more to report than that they were completed",
              {{"session", Align::left},
               {"participant", Align::left},
               {"state", Align::left},
               {"practice, right", Align::left},
               {"remarks", Align::left}}};
  for (const SessionRecord& one : sessions) {
    if (!is_remarkable(one)) continue;
    table.rows.push_back({std::to_string(one.row.session),
                          one.row.erased ? kNoFigure : one.row.participant,
                          one.row.erased ? "erased" : words_of(one.row.state),
                          one.row.erased ? kNoFigure : practice_of(one),
                          one.row.erased ? kNoFigure : remark_of(one)});
  }
  return table;
}

struct ServoNumbers {
  std::vector<double> p99_us;
  double worst_us = 0.0;
  double lowest_rate_hz = 0.0;
  std::int64_t overruns = 0;
  std::int64_t lost = 0;
};

ServoNumbers servo_numbers(const std::vector<ServoTrial>& trials) {
  ServoNumbers numbers;
  numbers.lowest_rate_hz = trials.front().health.rate_hz;
  for (const ServoTrial& one : trials) {
    numbers.p99_us.push_back(one.health.lateness_p99_us);
    numbers.worst_us = std::max(numbers.worst_us, one.health.lateness_worst_us);
    numbers.lowest_rate_hz = std::min(numbers.lowest_rate_hz, one.health.rate_hz);
    numbers.overruns += one.overruns;
    numbers.lost += one.health.lost;
  }
  return numbers;
}

}  // namespace

namespace {

Table looks_table(const std::vector<Look>& looks) {
  Table table{
      "looks",
      "When outcomes were looked at",
      {{"date", Align::left}, {"participants"}, {"look", Align::left}, {"why", Align::left}}};
  for (const Look& look : looks) {
    std::string kind = name_of(look.kind);
    if (!look.participant.empty()) kind += ", " + look.participant;
    if (look.station > 0) kind += fmt::format(", station {}", look.station);
    table.rows.push_back(
        {date_text(look.at), std::to_string(look.participants), kind, look.reason});
  }
  return table;
}

}  // namespace

Section participants_section(const Collection& collection, const std::vector<Look>& looks,
                             bool has_departures) {
  Section section{"participants", "Participants", {}};
  section.blocks.emplace_back(flow_of(collection.flow));
  for (const std::string& note : people_notes(collection)) {
    section.blocks.emplace_back(Cited{note, {}});
  }
  section.blocks.emplace_back(conditions_of(collection));
  if (auto deviations = deviations_table(collection.sessions)) {
    section.blocks.emplace_back(std::move(*deviations));
  } else {
    section.blocks.emplace_back(Cited{
        has_departures ? "No deviation was recorded during sessions; departures from the plan are "
                         "listed above."
                       : "No deviation from the protocol was recorded.",
        {}});
  }
  if (!looks.empty()) section.blocks.emplace_back(looks_table(looks));
  if (auto sessions = sessions_table(collection.sessions)) {
    section.blocks.emplace_back(std::move(*sessions));
  }
  return section;
}

Section registration_section(const design::Registration& registration) {
  Section section{"registration", "What was registered beforehand", {}, true};
  const auto stated = [](const std::string& text) { return text.empty() ? "not stated" : text; };
  Definitions definitions{
      {{"hypothesis", stated(registration.hypothesis)},
       {"primary test", stated(registration.primary_test)},
       {"participants planned",
        registration.participants > 0 ? std::to_string(registration.participants) : "not stated"},
       {"stopping rule", stated(registration.stopping_rule)},
       {"exclusions", stated(registration.exclusions)}}};
  for (const auto& field : design::fields_of(registration)) definitions.entries.push_back(field);
  section.blocks.emplace_back(std::move(definitions));
  return section;
}

std::optional<Table> servo_table(const Collection& collection) {
  if (collection.servo_trials.empty()) return {};
  ServoNumbers numbers = servo_numbers(collection.servo_trials);
  const Quartiles p99 = quartiles(std::move(numbers.p99_us));
  Table table{"servo",
              "How punctual the servo was, over trials in real time",
              {{"what", Align::left}, {"value"}}};
  table.rows = {{"trials", std::to_string(collection.servo_trials.size())},
                {"lowest mean rate of a trial (Hz)", plain_figure(numbers.lowest_rate_hz, 1)},
                {"trials' 99th percentile of lateness, median (µs)", plain_figure(p99.median, 1)},
                {"the same, quartiles (µs)",
                 plain_figure(p99.lower, 1) + " and " + plain_figure(p99.upper, 1)},
                {"latest tick of all (µs)", plain_figure(numbers.worst_us, 1)},
                {"ticks that came late", std::to_string(numbers.overruns)},
                {"samples that did not reach their trace", std::to_string(numbers.lost)}};
  return table;
}

}  // namespace touchtrial::analysis
