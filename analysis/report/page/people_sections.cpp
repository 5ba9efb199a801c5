// Participants, conditions of sessions, and exploration.
#include "analysis/outcomes/collection_records.hpp"
#include "analysis/report/page/frame_sections.hpp"
#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "core/text.hpp"
#include "core/utc.hpp"
#include "study/deviation_codes.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

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
    if (ran_unverified(one)) {
      name += std::string(", ") + study::kUnverifiedDevice;
    } else if (one.station) {
      name += one.station->calibration.empty()
                  ? ", without a certificate"
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

/// "3 interruptions in 1 session, 2 pauses in 2 sessions"; empty without any.
std::string incidents_of(const std::vector<SessionRecord>& sessions) {
  std::vector<std::string> parts;
  const auto add = [&](int SessionRecord::*kind, const char* name) {
    int all = 0;
    int with = 0;
    for (const SessionRecord& one : sessions) {
      all += one.*kind;
      with += one.*kind > 0 ? 1 : 0;
    }
    if (all > 0) parts.push_back(counted(all, name) + " in " + counted(with, "session"));
  };
  add(&SessionRecord::interruptions, "interruption");
  add(&SessionRecord::pauses, "pause");
  add(&SessionRecord::notes, "note");
  return listed(parts);
}

std::string dates_text(const std::vector<SessionRecord>& sessions) {
  const auto dates = dates_of(sessions);
  if (!dates) return "none: no session was in real time";
  return dates->first == dates->last ? dates->first : dates->first + " to " + dates->last;
}

std::string timeout_words(const std::string& on_timeout) {
  return on_timeout.empty() ? "" : ", then: " + on_timeout;
}

Definitions conditions_of(const Collection& collection) {
  const Prescription& rule = collection.prescription;
  Definitions definitions;
  auto& entries = definitions.entries;
  entries.emplace_back("sessions", std::to_string(collection.sessions.size()));
  entries.emplace_back("dates", dates_text(collection.sessions));
  if (rule.visits > 1) entries.emplace_back("visits", std::to_string(rule.visits));
  if (!rule.groups.empty()) entries.emplace_back("groups", listed(rule.groups));
  entries.emplace_back(
      "order", rule.intervals > 0 ? fmt::format("{}, {} planes a trial", rule.order, rule.intervals)
                                  : fmt::format("{}, {} of each stimulus", rule.order,
                                                counted(rule.repeats, "presentation")));
  entries.emplace_back(
      "exploration",
      rule.explore_limit_s > 0.0
          ? fmt::format("at most {} s{}{}", plain_figure(rule.explore_limit_s, 0),
                        rule.intervals > 0 ? " a plane" : "", timeout_words(rule.on_timeout))
          : "without a limit");
  if (!rule.sight.empty()) entries.emplace_back("vision blocked by", rule.sight);
  entries.emplace_back("masking noise", rule.masking_wanted
                                            ? plain_figure(rule.masking_dbfs, 0) + " dBFS"
                                            : "not prescribed");
  const std::string incidents = incidents_of(collection.sessions);
  if (!incidents.empty()) entries.emplace_back("incidents", incidents);
  const std::string devices = devices_of(collection.sessions);
  if (!devices.empty()) entries.emplace_back("device", devices);
  return definitions;
}

/// Keeps some of a table's columns.
/// \param kept  in ascending order, the first column among them
void keep_columns(const std::vector<std::size_t>& kept, Table& table) {
  const auto chosen = [&](const auto& all) {
    auto some = all;
    some.clear();
    for (const std::size_t i : kept) some.push_back(all[i]);
    return some;
  };
  table.columns = chosen(table.columns);
  for (std::vector<Cell>& row : table.rows) row = chosen(row);
}

/// Each deviation with the participants in whose sessions it occurred, or their number alone.
std::optional<Table> deviations_table(const Collection& collection) {
  const std::vector<SessionRecord>& sessions = collection.sessions;
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
  if (collection.is_public) {
    keep_columns({0, 2}, table);
    table.notes = {{"The code \"other\" stands for codes that were added during the study."}};
  }
  return table;
}

std::string remark_of(const SessionRecord& one) {
  std::vector<std::string> parts;
  if (!one.exclusion_reason.empty()) parts.push_back("excluded: " + exclusion_words(one));
  if (!one.row.replaced_by.empty()) {
    parts.push_back("replaced by " + one.row.replaced_by +
                    (one.replacement_reason.empty() ? "" : ": " + one.replacement_reason));
  }
  if (!one.stop_reason.empty()) parts.push_back("stopped: " + one.stop_reason);
  if (one.row.withdrawn) {
    parts.push_back("withdrew, data kept" +
                    (one.withdrawal_reason.empty() ? "" : ": " + one.withdrawal_reason));
  }
  if (one.interruptions > 0) parts.push_back(counted(one.interruptions, "interruption"));
  if (one.pauses > 0) parts.push_back(counted(one.pauses, "pause"));
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

/// Whether the table of sessions lists the session.
bool has_remarks(const SessionRecord& one) {
  return one.row.withdrawn || one.row.excluded ||
         one.row.state != record::SessionState::completed || one.resumed > 0 ||
         one.interruptions > 0 || one.pauses > 0 || !one.row.replaced_by.empty() ||
         one.practice.has_value();
}

std::optional<Table> sessions_table(const Collection& collection) {
  const std::vector<SessionRecord>& sessions = collection.sessions;
  if (collection.is_public || std::none_of(sessions.begin(), sessions.end(), has_remarks))
    return {};
  Table table{"sessions",
              "Sessions with practice, incidents or exclusions",
              {{"session", Align::left},
               {"participant", Align::left},
               {"state", Align::left},
               {"practice, right", Align::left},
               {"remarks", Align::left}}};
  for (const SessionRecord& one : sessions) {
    if (!has_remarks(one)) continue;
    table.rows.push_back({std::to_string(one.row.session),
                          one.row.erased ? kNoFigure : one.row.participant,
                          one.row.erased ? "erased" : std::string(name_of(one.row.state)),
                          one.row.erased ? kNoFigure : practice_of(one),
                          one.row.erased ? kNoFigure : remark_of(one)});
  }
  return table;
}

Table looks_table(const std::vector<Look>& looks, bool is_public) {
  Table table{
      "looks",
      "Looks at outcomes",
      {{"date", Align::left}, {"participants"}, {"look", Align::left}, {"why", Align::left}}};
  for (const Look& look : looks) {
    std::string kind = name_of(look.kind);
    if (!look.participant.empty() && !is_public) kind += ", " + look.participant;
    const bool is_dated = look.at.count() > 0;  // not in virtual time
    if (look.station > 0) kind += fmt::format(", station {}", look.station);
    table.rows.push_back({is_dated ? utc_words(look.at) : kNoFigure,
                          std::to_string(look.participants), kind, look.reason});
  }
  if (is_public) keep_columns({0, 1, 2}, table);
  return table;
}

/// "20 planned, 19 enrolled, 18 completed, 1 excluded, 0 withdrew; 17 in the results"
Cited people_sentence(const StudyHead& head) {
  const ParticipantFlow& flow = head.collection.flow;
  const int planned = head.course.planned;
  std::string text =
      fmt::format("{}{} enrolled, {} completed, {} excluded, {} withdrew; {} in the results.",
                  planned > 0 ? std::to_string(planned) + " planned, " : "", flow.enrolled,
                  head.course.completed, flow.excluded, flow.withdrawn, flow.analysed);
  if (head.course.excluded_afterwards > 0) {
    text += fmt::format(" Excluded after outcomes were seen: {}; the verdict counts these.",
                        counted(head.course.excluded_afterwards, "session"));
  }
  return {text};
}

/// "age: 20-29 (12), others (8)"
Cited bands_sentence(const Characteristic& of) {
  std::string text = of.name + ":";
  text[0] = static_cast<char>(text[0] - 'a' + 'A');
  if (of.bands.empty()) {
    return {fmt::format("{} not shown, because it would single out fewer than {} people.", text,
                        kMinOfBand)};
  }
  const char* separator = " ";
  for (const Band& band : of.bands) {
    text += fmt::format("{}{} ({})", separator, band.name, band.people);
    separator = ", ";
  }
  if (of.others > 0) {
    text += fmt::format(", others and not stated ({}; bands of fewer than {} are not shown)",
                        of.others, kMinOfBand);
  }
  return {text + "."};
}

struct Explored {
  const char* what;
  Quartiles Explorations::*of;
  int decimals;
  double unit = 1.0;
};

constexpr Explored kExplored[] = {
    {"time until answer (s)", &Explorations::answer_s, 1},
    {"time in contact (s)", &Explorations::contact_s, 1},
    {"path in contact (mm)", &Explorations::path_mm, 0},
    {"speed in contact (mm/s)", &Explorations::speed_mm_s, 0},
    {"force, rms (N)", &Explorations::force_n, 2},
    {"at the force limit (% of contact)", &Explorations::saturated, 1, 100.0}};

/// A column for each method.
std::optional<Table> explorations_table(const StudyHead& head) {
  Table table{
      "explorations", "Exploration in counted trials: medians and quartiles", {{"", Align::left}}};
  std::vector<const Explorations*> methods;
  Proportion missed;
  for (const Explorations& one : head.explorations) {
    if (one.trials == 0) continue;
    methods.push_back(&one);
    table.columns.push_back({head.explorations.size() > 1 ? one.method : "median (quartiles)"});
    missed.correct += one.without_response;
    missed.n += one.trials;
  }
  if (methods.empty()) return {};
  for (const Explored& row : kExplored) {
    std::vector<Cell>& cells = table.rows.emplace_back(std::vector<Cell>{row.what});
    for (const Explorations* one : methods) {
      cells.emplace_back(quartiles_figure(one->*row.of, row.decimals, row.unit));
    }
  }
  const double limit_s = head.collection.prescription.explore_limit_s;
  table.notes = {{fmt::format(
      "Trials of all participants, each with the same weight. {}; without a response: {} of {}.",
      limit_s > 0.0 ? plain_figure(limit_s, 0) + " s were allowed" : "Time was not limited",
      missed.correct, counted(missed.n, "trial"))}};
  return table;
}

/// "No (12), Sometimes (5)", or the quartiles of numbers.
std::string said_in(const QuestionSummary& of) {
  if (of.kind == study::QuestionKind::number) {
    return of.numbers.median
               ? fmt::format("median {}, quartiles {} and {}", plain_figure(of.numbers.median, 1),
                             plain_figure(of.numbers.lower, 1), plain_figure(of.numbers.upper, 1))
               : kNoFigure;
  }
  if (of.kind == study::QuestionKind::text) return "in words";
  std::vector<std::string> parts;
  for (const Band& option : of.options) {
    parts.push_back(fmt::format("{} ({})", option.name, option.people));
  }
  if (of.others > 0) {
    parts.push_back(
        fmt::format("others ({}; options of fewer than {} are not shown)", of.others, kMinOfBand));
  }
  return parts.empty() ? kNoFigure : listed(parts);
}

}  // namespace

Section participants_section(const Collection& collection, const StudyHead* head) {
  Section section{"participants", "Participants", {}};
  const auto add = [&](Block block) { section.blocks.emplace_back(std::move(block)); };
  if (head != nullptr) add(people_sentence(*head));
  if (Flow flow = flow_of(collection.flow);
      head == nullptr || !flow.steps.front().leaving.empty()) {
    add(std::move(flow));
  }
  if (head != nullptr) std::ranges::for_each(head->demographics, add, bands_sentence);
  for (const std::string& note : people_notes(collection)) add(Cited{note});
  if (auto deviations = deviations_table(collection)) {
    add(std::move(*deviations));
  } else {
    const bool has_departures = head != nullptr && !head->departures.empty();
    add(Cited{has_departures ? "No deviation was recorded during sessions."
                             : "No deviation from the protocol was recorded."});
  }
  if (head == nullptr) {
    add(conditions_of(collection));
    if (auto sessions = sessions_table(collection)) add(std::move(*sessions));
    return section;
  }
  if (auto explored = explorations_table(*head)) add(std::move(*explored));
  section.more.emplace_back(conditions_of(collection));
  if (auto sessions = sessions_table(collection)) section.more.emplace_back(std::move(*sessions));
  if (!head->looks.empty()) {
    section.more.emplace_back(looks_table(head->looks, collection.is_public));
  }
  return section;
}

std::string device_summary(const Collection& collection) {
  if (const std::string simulated = simulated_devices(collection); !simulated.empty()) {
    return simulated;
  }
  std::map<std::string, int> devices;
  for (const SessionRecord& one : collection.sessions) {
    if (one.row.erased) continue;
    ++devices[one.station && !one.station->model.empty() ? one.station->model : one.row.device];
  }
  std::vector<std::string> all;
  for (const auto& [name, n] : devices) all.push_back(name + " (" + counted(n, "session") + ")");
  return listed(all, " and ");
}

Section questionnaire_section(const StudyHead& head) {
  Section section{"said", "Answers to questions", {}};
  if (head.closing_answers.empty()) return section;
  Table questions{"questions",
                  "Answers to the questions after the session",
                  {{"question", Align::left}, {"participants"}, {"answers", Align::left}}};
  Table texts{"answers-in-words",
              "Answers in words",
              {{"question", Align::left}, {"participant", Align::left}, {"answer", Align::left}}};
  for (const QuestionSummary& one : head.closing_answers) {
    const std::string& wording = one.wording.empty() ? one.question : one.wording;
    questions.rows.push_back({wording, std::to_string(one.answered), said_in(one)});
    for (const auto& [participant, text] : one.texts) {
      texts.rows.push_back({one.question, participant, text});
    }
  }
  section.blocks.emplace_back(std::move(questions));
  if (!texts.rows.empty()) section.blocks.emplace_back(std::move(texts));
  return section;
}

}  // namespace touchtrial::analysis
