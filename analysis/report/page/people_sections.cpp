// The sections on participants and on their answers to questions.
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
#include <fmt/ranges.h>

namespace touchtrial::analysis {
namespace {

/// Adds "2 excluded: moved the device; fell asleep". Repeated reasons are followed by their count.
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
  step.losses.push_back(text);
}

Flow flow_of(const ParticipantFlow& flow) {
  FlowStep enrolment{counted(flow.enrolled, "participant") + " enrolled"};
  add_people(flow.erased, "withdrew; the keys of their sealed data were destroyed",
             enrolment.losses);
  add_people(flow.replaced, "replaced by another participant", enrolment.losses);
  add_excluded(flow, enrolment);
  add_people(flow.stopped, "stopped before the end", enrolment.losses);
  add_people(flow.open, "not ended yet", enrolment.losses);
  add_people(flow.other_kind, "in pilot or simulated sessions", enrolment.losses);
  add_people(flow.unseen, "ended after the interim look", enrolment.losses);
  return {"flow",
          "Participants from enrolment to analysis, each counted once",
          {enrolment, {counted(flow.analysed, "participant") + " analysed"}}};
}

std::string devices_of(const std::vector<SessionRecord>& sessions) {
  std::map<std::string, int> devices;
  for (const SessionRecord& session : sessions) {
    if (session.row.erased) continue;
    std::string name = session.row.device;
    if (session.station && !session.station->model.empty()) name += ", " + session.station->model;
    if (!session.device_serial.empty()) name += ", serial " + session.device_serial;
    if (session.station && !session.station->firmware.empty())
      name += ", firmware " + session.station->firmware;
    if (ran_unverified(session)) {
      name += std::string(", ") + study::kUnverifiedDevice;
    } else if (session.station) {
      name += session.station->calibration.empty()
                  ? ", without a certificate"
                  : ", certificate " + session.station->calibration.substr(0, 12);
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
    int incidents = 0;
    int affected = 0;
    for (const SessionRecord& session : sessions) {
      incidents += session.*kind;
      affected += session.*kind > 0 ? 1 : 0;
    }
    if (incidents > 0) {
      parts.push_back(counted(incidents, name) + " in " + counted(affected, "session"));
    }
  };
  add(&SessionRecord::interruptions, "interruption");
  add(&SessionRecord::pauses, "pause");
  add(&SessionRecord::notes, "note");
  return listed(parts);
}

std::string dates_text(const std::vector<SessionRecord>& sessions) {
  const auto dates = dates_of(sessions);
  if (!dates) return "none: no session ran in real time";
  return dates->first == dates->last ? dates->first : dates->first + " to " + dates->last;
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
      "exploration", rule.explore_limit_s > 0.0
                         ? fmt::format("at most {} s{}{}", plain_figure(rule.explore_limit_s, 0),
                                       rule.intervals > 0 ? " a plane" : "",
                                       rule.on_timeout.empty() ? "" : ", then: " + rule.on_timeout)
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

void remove_column(std::ptrdiff_t column, Table& table) {
  table.columns.erase(table.columns.begin() + column);
  for (std::vector<Cell>& row : table.rows) row.erase(row.begin() + column);
}

/// The participants with each deviation; in public reports only their number.
std::optional<Table> deviations_table(const Collection& collection) {
  const std::vector<SessionRecord>& sessions = collection.sessions;
  std::map<std::pair<std::string, std::string>, std::set<std::string>> people_by_deviation;
  for (const SessionRecord& session : sessions) {
    for (const Deviation& deviation : session.deviations) {
      people_by_deviation[{deviation.code, deviation.text}].insert(session.row.participant);
    }
  }
  if (people_by_deviation.empty()) return {};
  Table table{"deviations",
              "Deviations from the protocol",
              {{"code", Align::left},
               {"deviation", Align::left},
               {"participants"},
               {"names", Align::left}}};
  constexpr std::size_t kMaxNames = 10;
  for (const auto& [deviation, people] : people_by_deviation) {
    std::vector<std::string> names(people.begin(), people.end());
    const bool is_long = names.size() > kMaxNames;
    if (is_long) names.resize(kMaxNames);
    table.rows.push_back({deviation.first, deviation.second.empty() ? kNoFigure : deviation.second,
                          std::to_string(people.size()),
                          listed(names, " and ") + (is_long ? " …" : "")});
  }
  if (collection.is_public) {
    remove_column(3, table);
    remove_column(1, table);
    table.notes = {{"The code \"other\" stands for codes that were added during the study."}};
  }
  return table;
}

std::string remark_of(const SessionRecord& session) {
  std::vector<std::string> parts;
  if (!session.exclusion_reason.empty()) parts.push_back("excluded: " + exclusion_words(session));
  if (!session.row.replaced_by.empty()) {
    parts.push_back("replaced by " + session.row.replaced_by +
                    (session.replacement_reason.empty() ? "" : ": " + session.replacement_reason));
  }
  if (!session.stop_reason.empty()) parts.push_back("stopped: " + session.stop_reason);
  if (session.row.withdrawn) {
    parts.push_back("withdrew, data kept" +
                    (session.withdrawal_reason.empty() ? "" : ": " + session.withdrawal_reason));
  }
  if (session.interruptions > 0) parts.push_back(counted(session.interruptions, "interruption"));
  if (session.pauses > 0) parts.push_back(counted(session.pauses, "pause"));
  if (session.resumed > 0) parts.push_back("resumed " + counted(session.resumed, "time"));
  return parts.empty() ? kNoFigure : fmt::format("{}", fmt::join(parts, "; "));
}

std::string practice_of(const SessionRecord& session) {
  if (!session.practice) return kNoFigure;
  const std::string correct =
      session.practice->correct ? fmt::format("{} of ", *session.practice->correct) : "";
  return fmt::format("{}{} in {}{}", correct, session.practice->presentations,
                     counted(session.practice->rounds, "round"),
                     session.practice->passed ? "" : ", not passed");
}

bool has_remarks(const SessionRecord& session) {
  return session.row.withdrawn || session.row.excluded ||
         session.row.state != record::SessionState::completed || session.resumed > 0 ||
         session.interruptions > 0 || session.pauses > 0 || !session.row.replaced_by.empty() ||
         session.practice.has_value();
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
  for (const SessionRecord& session : sessions) {
    if (!has_remarks(session)) continue;
    table.rows.push_back({std::to_string(session.row.session),
                          session.row.erased ? kNoFigure : session.row.participant,
                          session.row.erased ? "erased" : std::string(name_of(session.row.state)),
                          session.row.erased ? kNoFigure : practice_of(session),
                          session.row.erased ? kNoFigure : remark_of(session)});
  }
  return table;
}

Table looks_table(const std::vector<Look>& looks, bool is_public) {
  Table table{
      "looks",
      "Looks at outcomes",
      {{"date", Align::left}, {"participants"}, {"look", Align::left}, {"reason", Align::left}}};
  for (const Look& look : looks) {
    std::string kind = name_of(look.kind);
    if (!look.participant.empty() && !is_public) kind += ", " + look.participant;
    const bool is_dated = look.at.count() > 0;  // not in virtual time
    if (look.station > 0) kind += fmt::format(", station {}", look.station);
    table.rows.push_back({is_dated ? utc_words(look.at) : kNoFigure,
                          std::to_string(look.participants), kind, look.reason});
  }
  if (is_public) remove_column(3, table);
  return table;
}

/// "20 planned, 19 enrolled, 18 completed, 1 excluded, 0 withdrew; 17 in the results"
CitedText people_sentence(const StudyHead& head) {
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

/// "Age: 20-29 (12), others and not stated (8)."
CitedText bands_sentence(const Characteristic& characteristic) {
  std::string text = characteristic.name + ":";
  text[0] = static_cast<char>(text[0] - 'a' + 'A');
  if (characteristic.bands.empty()) {
    return {fmt::format("{} not shown, because every band has fewer than {} people.", text,
                        kMinBandPeople)};
  }
  const char* separator = " ";
  for (const Band& band : characteristic.bands) {
    text += fmt::format("{}{} ({})", separator, band.name, band.people);
    separator = ", ";
  }
  if (characteristic.others > 0) {
    text += fmt::format(", others and not stated ({}; bands of fewer than {} are not shown)",
                        characteristic.others, kMinBandPeople);
  }
  return {text + "."};
}

struct ExplorationRow {
  const char* title;
  Quartiles Explorations::*quartiles;
  int decimals;
  double unit = 1.0;
};

constexpr ExplorationRow kExplorationRows[] = {
    {"time until answer (s)", &Explorations::answer_s, 1},
    {"time in contact (s)", &Explorations::contact_s, 1},
    {"path in contact (mm)", &Explorations::path_mm, 0},
    {"speed in contact (mm/s)", &Explorations::speed_mm_s, 0},
    {"force, rms (N)", &Explorations::force_n, 2},
    {"at the force limit (% of contact)", &Explorations::saturated, 1, 100.0}};

/// One column per method.
std::optional<Table> explorations_table(const StudyHead& head) {
  Table table{
      "explorations", "Exploration in counted trials: medians and quartiles", {{"", Align::left}}};
  std::vector<const Explorations*> methods;
  Proportion unanswered;
  for (const Explorations& exploration : head.explorations) {
    if (exploration.trials == 0) continue;
    methods.push_back(&exploration);
    table.columns.push_back(
        {head.explorations.size() > 1 ? exploration.method : "median (quartiles)"});
    unanswered.correct += exploration.without_response;
    unanswered.n += exploration.trials;
  }
  if (methods.empty()) return {};
  for (const ExplorationRow& row : kExplorationRows) {
    std::vector<Cell>& cells = table.rows.emplace_back(std::vector<Cell>{row.title});
    for (const Explorations* exploration : methods) {
      cells.emplace_back(quartiles_figure(exploration->*row.quartiles, row.decimals, row.unit));
    }
  }
  const double limit_s = head.collection.prescription.explore_limit_s;
  table.notes = {{fmt::format(
      "All trials have the same weight. {}; without a response: {} of {}.",
      limit_s > 0.0 ? plain_figure(limit_s, 0) + " s were allowed" : "Time was not limited",
      unanswered.correct, counted(unanswered.n, "trial"))}};
  return table;
}

/// "No (12), Sometimes (5)", or the quartiles of numbers.
std::string answers_words(const QuestionSummary& question) {
  if (question.kind == study::QuestionKind::number) {
    return question.numbers.median ? fmt::format("median {}, quartiles {} and {}",
                                                 plain_figure(question.numbers.median, 1),
                                                 plain_figure(question.numbers.lower, 1),
                                                 plain_figure(question.numbers.upper, 1))
                                   : kNoFigure;
  }
  if (question.kind == study::QuestionKind::text) return "in words";
  std::vector<std::string> parts;
  for (const Band& option : question.options) {
    parts.push_back(fmt::format("{} ({})", option.name, option.people));
  }
  if (question.others > 0) {
    parts.push_back(fmt::format("others ({}; options of fewer than {} are not shown)",
                                question.others, kMinBandPeople));
  }
  return parts.empty() ? kNoFigure : listed(parts);
}

}  // namespace

Section participants_section(const Collection& collection, const StudyHead* head) {
  Section section{"participants", "Participants", {}};
  const auto add = [&](Block block) { section.blocks.emplace_back(std::move(block)); };
  if (head != nullptr) add(people_sentence(*head));
  if (Flow flow = flow_of(collection.flow); head == nullptr || !flow.steps.front().losses.empty()) {
    add(std::move(flow));
  }
  if (head != nullptr) std::ranges::for_each(head->demographics, add, bands_sentence);
  for (const std::string& note : people_notes(collection)) add(CitedText{note});
  if (auto deviations = deviations_table(collection)) {
    add(std::move(*deviations));
  } else {
    const bool has_departures = head != nullptr && !head->departures.empty();
    add(CitedText{has_departures ? "No deviation was recorded during sessions."
                                 : "No deviation from the protocol was recorded."});
  }
  if (head == nullptr) {
    add(conditions_of(collection));
    if (auto sessions = sessions_table(collection)) add(std::move(*sessions));
    return section;
  }
  if (auto explored = explorations_table(*head)) add(std::move(*explored));
  section.folded_blocks.emplace_back(conditions_of(collection));
  if (auto sessions = sessions_table(collection))
    section.folded_blocks.emplace_back(std::move(*sessions));
  if (!head->looks.empty()) {
    section.folded_blocks.emplace_back(looks_table(head->looks, collection.is_public));
  }
  return section;
}

std::string device_summary(const Collection& collection) {
  if (const std::string simulated = simulated_devices(collection); !simulated.empty()) {
    return simulated;
  }
  std::map<std::string, int> devices;
  for (const SessionRecord& session : collection.sessions) {
    if (session.row.erased) continue;
    ++devices[session.station && !session.station->model.empty() ? session.station->model
                                                                 : session.row.device];
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
  for (const QuestionSummary& question : head.closing_answers) {
    const std::string& wording = question.wording.empty() ? question.question : question.wording;
    questions.rows.push_back({wording, std::to_string(question.answered), answers_words(question)});
    for (const auto& [participant, text] : question.texts) {
      texts.rows.push_back({question.question, participant, text});
    }
  }
  section.blocks.emplace_back(std::move(questions));
  if (!texts.rows.empty()) section.blocks.emplace_back(std::move(texts));
  return section;
}

}  // namespace touchtrial::analysis
