#include "analysis/outcomes/study_status.hpp"

#include "analysis/outcomes/collection.hpp"
#include "analysis/report/json_figures.hpp"
#include "analysis/report/text_figures.hpp"
#include "analysis/report/text_table.hpp"
#include "core/text.hpp"
#include "core/utc.hpp"
#include "record/payload_json.hpp"
#include "study/deviation_codes.hpp"

#include <algorithm>
#include <map>
#include <ratio>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::analysis {
namespace {

std::string state_of_session(const record::SessionRow& row) {
  if (row.erased) return "erased";
  if (!row.replaced_by.empty()) return "replaced";
  if (row.excluded) return "excluded";
  if (row.withdrawn) return "withdrawn";
  if (row.state == record::SessionState::completed) return "complete";
  return row.state == record::SessionState::stopped ? "stopped" : "open";
}

using LastConsents = std::map<std::string, std::string>;

PersonStatus person_status(const SessionRecord& record, const record::StudyCommitment& commitment,
                           const LastConsents& consents) {
  const record::SessionRow& row = record.row;
  PersonStatus person;
  person.participant = row.participant;
  person.session = row.session;
  person.enrolment = row.enrolment;
  person.visit = row.visit;
  person.station = row.station;
  person.group = record.group;
  person.state = state_of_session(row);
  person.counts = session_counts(row, commitment);
  person.can_resume = row.can_resume();
  person.opened_utc = record.opened_utc;
  person.device = row.device;
  if (record.station) {
    person.was_felt = !record.station->visual;
    person.certificate = record.station->calibration;
  }
  if (std::ranges::count(record.deviations, "no-certificate", &Deviation::code) > 0) {
    person.certificate.clear();
  }
  if (ran_unverified(record)) person.certificate = study::kUnverifiedDevice;
  const auto consent = consents.find(row.participant);
  if (consent != consents.end()) person.consent = consent->second;
  return person;
}

void add_times_and_answers(const record::StudyStore& store, std::vector<PersonStatus>& people) {
  std::map<int, PersonStatus*> by_session;
  for (PersonStatus& one : people) by_session[one.session] = &one;
  for (const record::Event& event : store.events(0)) {
    if (event.kind != record::EventKind::session_closed || store.commitment().simulated) continue;
    const auto found = by_session.find(record::session_about(event));
    if (found != by_session.end() && found->second->state != "erased") {
      found->second->ended_utc = utc_text(event.at);
    }
  }
  for (const record::TrialRow& trial : store.trials()) {
    const bool is_done =
        trial.state == record::TrialState::answered || trial.state == record::TrialState::timed_out;
    const auto found = by_session.find(trial.session);
    if (is_done && found != by_session.end() && found->second->state != "erased") {
      ++found->second->answered;
    }
  }
}

/// Adds replacements and consented participants who have no session yet.
void add_upcoming_people(const StatusSources& sources, const LastConsents& consents,
                         const std::vector<record::SessionRow>& rows,
                         std::vector<PersonStatus>& people) {
  std::set<std::string> listed_participants;
  for (const record::SessionRow& row : rows) {
    if (row.replaced_by.empty()) listed_participants.insert(row.participant);
  }
  const auto add = [&](const std::string& id, const std::string& in_place_of, int enrolment,
                       int visit) {
    if (!listed_participants.insert(id).second) return;
    PersonStatus one;
    one.participant = id;
    one.visit = visit;
    one.enrolment = enrolment;
    one.state = "to come";
    one.in_place_of = in_place_of;
    const auto consent = consents.find(id);
    if (consent != consents.end()) one.consent = consent->second;
    people.push_back(std::move(one));
  };
  for (const record::SessionRow& row : rows) {
    if (row.replaced_by.empty()) continue;
    // A replacement begins with the first visit; a restarted session repeats its visit.
    const bool is_restart = row.replaced_by == row.participant;
    add(row.replaced_by, row.erased ? "" : row.participant, row.enrolment,
        is_restart ? row.visit : 1);
  }
  for (const record::SessionRow& row : rows) listed_participants.insert(row.participant);
  for (const record::PersonalRecord& one : sources.consents) add(one.participant, "", 0, 1);
}

std::optional<OrderBlocks> order_blocks(const std::vector<record::SessionRow>& rows,
                                        const record::StudyCommitment& commitment,
                                        const StatusSources& sources,
                                        const Prescription& prescription) {
  const int orders = prescription.method_orders;
  const bool is_single_station =
      commitment.station && commitment.station->name == study::kOnlyStation;
  if (orders < 2 || (!is_single_station && !sources.station)) return std::nullopt;
  // Orders are assigned within each group, and group assignments are sealed.
  if (!prescription.groups.empty()) return std::nullopt;
  std::map<int, std::set<int>> filled;  // enrolment numbers with a counting session, by block
  for (const record::SessionRow& row : rows) {
    const std::optional<int> place = is_single_station ? std::optional(row.enrolment - 1)
                                                       : sources.station->place_of(row.enrolment);
    if (!place) continue;
    std::set<int>& numbers = filled[*place / orders];
    if (session_counts(row, commitment)) numbers.insert(row.enrolment);
  }
  OrderBlocks blocks{.orders = orders};
  for (const auto& [block, numbers] : filled) {
    const int filled_numbers = static_cast<int>(numbers.size());
    if (filled_numbers == orders) {
      ++blocks.complete;
    } else {
      blocks.open.push_back(filled_numbers);
    }
  }
  return blocks;
}

template <typename Condition>
std::vector<std::string> ids_with(const StudyStatus& status, Condition condition) {
  std::vector<std::string> ids;
  for (const PersonStatus& one : status.people) {
    if (!one.participant.empty() && condition(one)) ids.push_back(one.participant);
  }
  return ids;
}

void add_tasks_about_people(const StudyStatus& status, const StatusSources& sources,
                            std::vector<std::string>& tasks) {
  const auto add = [&](const std::vector<std::string>& ids, const std::string& task) {
    if (!ids.empty()) tasks.push_back(listed(ids, " and ") + ": " + task);
  };
  add(ids_with(status, [](const PersonStatus& one) { return one.can_resume; }),
      "the session is open; resume it, or end it");
  for (const PersonStatus& one : status.people) {
    if (!one.in_place_of.empty() && one.in_place_of != one.participant) {
      tasks.push_back(fmt::format("{} replaces {} (enrolment {}) and has no session yet",
                                  one.participant, one.in_place_of, one.enrolment));
    }
  }
  add(ids_with(status,
               [](const PersonStatus& one) {
                 return one.state == "to come" && one.in_place_of == one.participant;
               }),
      "the session was restarted and has not begun");
  for (const UpcomingVisit& one : status.upcoming_visits) {
    tasks.push_back(fmt::format("{}: visit {} of {} is to come{}{}", one.participant, one.visit,
                                status.visits, one.from ? ", from " + utc_words(*one.from) : "",
                                one.until ? " to " + utc_words(*one.until) : ""));
  }
  if (status.simulated) return;
  if (sources.has_consents) {
    add(ids_with(
            status,
            [](const PersonStatus& one) { return one.state != "erased" && one.consent.empty(); }),
        "no consent is recorded");
  }
  if (!sources.consent_version.empty()) {
    add(ids_with(status,
                 [&](const PersonStatus& one) {
                   return !one.consent.empty() && one.consent != sources.consent_version;
                 }),
        "consented to a version other than " + sources.consent_version +
            ", which the study requires");
  }
  add(ids_with(status,
               [](const PersonStatus& one) {
                 return one.counts && one.was_felt && one.certificate == study::kUnverifiedDevice;
               }),
      std::string(study::kUnverifiedDevice) + ": the session had no valid device certificate");
  add(ids_with(status,
               [](const PersonStatus& one) {
                 return one.counts && one.was_felt && one.certificate.empty();
               }),
      "the session had no valid device certificate");
}

void add_tasks_about_study(const StudyStatus& status, std::vector<std::string>& tasks) {
  const bool is_full = status.planned > 0 && status.complete >= status.planned;
  if (!status.state.closed && status.planned > status.complete) {
    tasks.push_back(counted(status.planned - status.complete, "participant") + " to come of " +
                    std::to_string(status.planned) + " that are planned");
  }
  if (!status.state.closed && is_full) {
    tasks.emplace_back(
        "all planned participants are complete: end collection with `touchtrial close`");
  }
  if (status.state.closed && (!status.state.unblinded || status.state.interim)) {
    tasks.emplace_back("collection has ended: `touchtrial unblind` opens the outcomes");
  }
}

/// A cell's text; "-" if empty.
std::string text_or_dash(const std::string& text) {
  return text.empty() ? "-" : text;
}

std::string number_or_dash(int number) {
  return number == 0 ? "-" : std::to_string(number);
}

/// "2026-01-31 14:05" of an ISO date.
std::string minute_of(const std::string& iso) {
  constexpr std::size_t kDay = 10;
  constexpr std::size_t kMinute = 16;
  return iso.size() < kMinute
             ? "-"
             : iso.substr(0, kDay) + " " + iso.substr(kDay + 1, kMinute - kDay - 1);
}

std::string orders_sentence(const OrderBlocks& blocks) {
  std::string text =
      fmt::format("orders of methods: {}, assigned in blocks of {} enrolment numbers; {} complete",
                  blocks.orders, blocks.orders, counted(blocks.complete, "block"));
  for (const int filled : blocks.open) {
    text += fmt::format(", one with {} of {}", filled, blocks.orders);
  }
  return text;
}

std::vector<std::string> balance_lines(const StudyStatus& status) {
  std::vector<std::string> lines = status.balance;
  if (status.orders) lines.insert(lines.begin(), orders_sentence(*status.orders));
  return lines;
}

std::string people_text(const StudyStatus& status) {
  if (status.people.empty()) return "no participant so far\n";
  std::vector<std::string> header{"participant",  "session", "number",      "state", "trials",
                                  "opened (UTC)", "consent", "certificate", "device"};
  const bool has_visits = status.visits > 1;
  const bool has_groups = std::ranges::any_of(
      status.people, [](const PersonStatus& one) { return !one.group.empty(); });
  constexpr std::ptrdiff_t kVisitColumn = 3;
  if (has_visits) header.insert(header.begin() + kVisitColumn, "visit");
  if (has_groups) header.emplace_back("group");
  if (status.stations > 0) header.emplace_back("station");
  const std::set<std::string> numbers{"session", "number", "trials", "station"};
  std::set<std::size_t> left_aligned;
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (!numbers.contains(header[i])) left_aligned.insert(i);
  }
  TextTable table(header, left_aligned);
  constexpr std::size_t kCertificateDigits = 12;
  for (const PersonStatus& one : status.people) {
    std::vector<std::string> cells{
        text_or_dash(one.participant),
        number_or_dash(one.session),
        number_or_dash(one.enrolment),
        one.state,
        one.session == 0 ? "-" : std::to_string(one.answered),
        minute_of(one.opened_utc),
        text_or_dash(one.consent),
        text_or_dash(one.certificate == study::kUnverifiedDevice
                         ? one.certificate
                         : one.certificate.substr(0, kCertificateDigits)),
        text_or_dash(one.device)};
    if (has_visits) {
      cells.insert(cells.begin() + kVisitColumn, fmt::format("{} of {}", one.visit, status.visits));
    }
    if (has_groups) cells.push_back(text_or_dash(one.group));
    if (status.stations > 0) cells.push_back(number_or_dash(one.station));
    table.add(std::move(cells));
  }
  return table.text();
}

nlohmann::ordered_json person_json(const PersonStatus& one) {
  return {{"participant", one.participant},
          {"session", one.session},
          {"enrolment", one.enrolment},
          {"visit", one.visit},
          {"group", one.group},
          {"station", one.station},
          {"state", one.state},
          {"counts", one.counts},
          {"may_go_on", one.can_resume},
          {"answered", one.answered},
          {"opened_utc", one.opened_utc},
          {"ended_utc", one.ended_utc},
          {"consent", one.consent},
          {"device", one.device},
          {"certificate", one.certificate},
          {"in_place_of", one.in_place_of}};
}

}  // namespace

std::vector<UpcomingVisit> upcoming_visits(const record::StudyStore& store) {
  const Prescription prescription = prescription_from_json(store.commitment().configuration);
  if (prescription.visits < 2 || store.state().closed) return {};
  std::map<int, std::chrono::nanoseconds> opened;
  for (const record::Event& event : store.events(0)) {
    if (event.kind == record::EventKind::session_opened) {
      opened[record::from_json<record::SessionOpenedBody>(event.body).session] = event.at;
    }
  }
  using Days = std::chrono::duration<double, std::ratio<86'400>>;
  const auto add_days = [](std::chrono::nanoseconds start, double days) {
    return start + std::chrono::ceil<std::chrono::nanoseconds>(Days(days));
  };
  std::map<std::string, const record::SessionRow*> last;
  const std::vector<record::SessionRow> rows = store.sessions();
  for (const record::SessionRow& row : rows) {
    if (!row.replaced_by.empty()) continue;
    const record::SessionRow*& session = last[row.participant];
    if (session == nullptr || session->visit < row.visit) session = &row;
  }
  std::vector<UpcomingVisit> visits;
  for (const auto& [participant, row] : last) {
    const bool has_next_visit = row->state == record::SessionState::completed && !row->excluded &&
                                !row->withdrawn && row->visit < prescription.visits;
    if (!has_next_visit) continue;
    UpcomingVisit& next = visits.emplace_back();
    next.participant = participant;
    next.visit = row->visit + 1;
    if (row->simulated) continue;
    next.from = add_days(opened[row->session], prescription.min_days);
    if (prescription.max_days) {
      next.until = add_days(opened[row->session], *prescription.max_days);
    }
  }
  std::ranges::stable_sort(visits, {}, &UpcomingVisit::from);
  return visits;
}

StudyStatus status_before(const std::string& study, const std::string& protocol,
                          const StatusSources& sources) {
  StudyStatus status;
  status.study = study;
  status.protocol = protocol;
  status.planned = sources.planned;
  LastConsents consents;
  for (const record::PersonalRecord& one : sources.consents) {
    consents[one.participant] = one.consent_version;
  }
  add_upcoming_people(sources, consents, {}, status.people);
  status.tasks.emplace_back("there is no database yet; the first session creates it");
  add_tasks_about_people(status, sources, status.tasks);
  add_tasks_about_study(status, status.tasks);
  return status;
}

StudyStatus status_of(const record::StudyStore& store, const StatusSources& sources) {
  const record::StudyCommitment& commitment = store.commitment();
  const Collection collection = load_collection(store);
  const std::vector<record::SessionRow> rows = store.sessions();
  LastConsents consents;
  for (const record::PersonalRecord& one : sources.consents) {
    consents[one.participant] = one.consent_version;
  }
  StudyStatus status;
  status.study = commitment.study;
  status.protocol = commitment.protocol;
  status.state = store.state();
  status.simulated = commitment.simulated;
  status.pilot = commitment.pilot;
  status.stations = store.stations();
  status.planned = commitment.pilot ? 0 : sources.planned;
  status.visits = collection.prescription.visits;
  for (const SessionRecord& record : collection.sessions) {
    status.people.push_back(person_status(record, commitment, consents));
  }
  add_times_and_answers(store, status.people);
  const std::set<int> counted = counted_sessions(rows, commitment);
  std::set<std::pair<std::string, int>> complete;
  for (const record::SessionRow& row : rows) {
    if (counted.contains(row.session)) complete.emplace(row.participant, row.enrolment);
  }
  status.complete = static_cast<int>(complete.size());
  if (!status.state.closed && status.stations == 0) {
    add_upcoming_people(sources, consents, rows, status.people);
  }
  status.orders = order_blocks(rows, commitment, sources, collection.prescription);
  status.upcoming_visits = upcoming_visits(store);
  add_tasks_about_people(status, sources, status.tasks);
  add_tasks_about_study(status, status.tasks);
  return status;
}

std::string status_text(const StudyStatus& status, const std::vector<NextCommand>& next) {
  std::string text = simulated_line(status.simulated);
  if (!status.study.empty()) text += fmt::format("{} ({}): ", status.study, status.protocol);
  text += fmt::format(
      "{}, {}{} complete{}{}\n", name_of(status.state), counted(status.complete, "participant"),
      status.planned > 0 ? fmt::format(" of {}", status.planned) : "",
      status.state.question ? "; a registered look was made" : "", status.pilot ? "; PILOT" : "");
  if (!status.head_fault.empty()) text += "EVENTS ARE MISSING: " + status.head_fault + "\n";
  text += people_text(status);
  const auto add_list = [&](const char* title, const std::vector<std::string>& lines) {
    if (!lines.empty()) text += heading(title, status.simulated);
    for (const std::string& line : lines) text += wrapped("  ", line);
  };
  add_list("counterbalancing", balance_lines(status));
  add_list("left to do", status.tasks);
  if (!next.empty()) text += heading("next", status.simulated);
  for (const NextCommand& one : next) text += "  " + one.what + ":\n    " + one.command + "\n";
  return text;
}

std::string status_json(const StudyStatus& status, const std::vector<NextCommand>& next) {
  nlohmann::ordered_json object{{"study", status.study}, {"protocol", status.protocol}};
  put_stamp(object, status.simulated);
  put_state(object, status.state, status.pilot);
  object["stations"] = status.stations;
  object["planned"] = nullptr;
  if (status.planned > 0) object["planned"] = status.planned;
  object["visits"] = status.visits;
  object["complete"] = status.complete;
  object["people"] = nlohmann::ordered_json::array();
  for (const PersonStatus& one : status.people) object["people"].push_back(person_json(one));
  object["upcoming_visits"] = nlohmann::ordered_json::array();
  for (const UpcomingVisit& one : status.upcoming_visits) {
    nlohmann::ordered_json visit{{"participant", one.participant}, {"visit", one.visit}};
    visit["from"] = nullptr;
    if (one.from) visit["from"] = utc_text(*one.from);
    visit["until"] = nullptr;
    if (one.until) visit["until"] = utc_text(*one.until);
    object["upcoming_visits"].push_back(std::move(visit));
  }
  object["orders"] = nullptr;
  if (status.orders) {
    object["orders"] = {{"orders", status.orders->orders},
                        {"complete_blocks", status.orders->complete},
                        {"begun_blocks", status.orders->open}};
  }
  object["balance"] = status.balance;
  object["left"] = status.tasks;
  object["head_fault"] = status.head_fault;
  object["next"] = nlohmann::ordered_json::array();
  for (const NextCommand& one : next) {
    object["next"].push_back({{"what", one.what}, {"command", one.command}});
  }
  return json_text(object);
}

}  // namespace touchtrial::analysis
