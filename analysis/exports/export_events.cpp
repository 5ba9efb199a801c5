#include "analysis/exports/export_events.hpp"

#include "analysis/exports/data_table.hpp"
#include "analysis/exports/export_folder.hpp"
#include "analysis/sealed_sessions.hpp"
#include "protocols/store/payload_json.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// The kinds of events that no other export lists one by one.
constexpr std::array kKinds = {store::EventKind::participant_noted,
                               store::EventKind::calibrated,
                               store::EventKind::instructed,
                               store::EventKind::practised,
                               store::EventKind::interrupted,
                               store::EventKind::break_taken,
                               store::EventKind::paused,
                               store::EventKind::stopped,
                               store::EventKind::noted,
                               store::EventKind::ticked,
                               store::EventKind::deviated,
                               store::EventKind::questioned,
                               store::EventKind::explored_again,
                               store::EventKind::block_restarted,
                               store::EventKind::resumed};

/// The detail of an interruption. Empty for other events, and for interruptions in virtual time.
store::InterruptionDetail detail_of(const store::Event& event, const SecretKey& own) {
  if (event.kind != store::EventKind::interrupted || event.sealed.empty()) return {};
  return store::interruption_from_json(opened_part(event, own));
}

int session_of(const store::Event& event) {
  return event.kind == store::EventKind::participant_noted
             ? store::note_from_json(event.body).session
             : event.session;
}

/// Removes carriage returns, because all files of an export end their lines with single line feeds.
ExportFile flight_file(const std::string& name, std::string flight) {
  std::erase(flight, '\r');
  return text_file(name, std::move(flight));
}

}  // namespace

std::vector<std::filesystem::path> export_events(const store::StudyStore& store,
                                                 const design::StudyKey& key,
                                                 const Outcomes& outcomes,
                                                 const std::filesystem::path& folder) {
  std::map<int, const store::SessionRow*> shown;
  for (const SessionOutcome& session : outcomes.sessions) shown[session.row.session] = &session.row;
  const std::map<int, SecretKey> keys = participant_keys(store, key);
  DataTable table{{"participant", "session", "event", "kind", "at_s", "body", "safety_fault",
                   "device_fault", "flight", "simulated"},
                  {}};
  std::vector<ExportFile> files;
  store.for_each_of(kKinds, [&](const store::Event& event) {
    const auto session = shown.find(session_of(event));
    const auto own = keys.find(session_of(event));
    if (session == shown.end() || own == keys.end()) return;
    const store::SessionRow& row = *session->second;
    store::InterruptionDetail detail = detail_of(event, own->second);
    std::string flight;
    if (detail.ticks > 0) {
      flight = fmt::format("{}flight_{}_{}.csv", row.simulated ? "SIMULATED_" : "", row.session,
                           event.sequence);
      files.push_back(flight_file(flight, std::move(detail.flight)));
    }
    table.rows.push_back({row.participant, std::int64_t{row.session}, event.sequence,
                          std::string(name_of(event.kind)), event.at, event.body,
                          detail.safety_fault, detail.device_fault, flight,
                          std::int64_t{row.simulated}});
  });
  files.insert(files.begin(), text_file("events.csv", csv_text(table)));
  const store::StudyCommitment& commitment = store.commitment();
  return write_export(folder, {commitment.study, commitment.study_id, "events"}, files);
}

}  // namespace touchtrial::analysis
