#include "protocols/store/tables.hpp"

#include <array>

namespace touchtrial::store {
namespace {

using enum ColumnType;
using Names = std::string_view;

constexpr auto kEvents = std::to_array<TableColumn>({{"session", integer},
                                                     {"sequence", integer},
                                                     {"kind", text},
                                                     {"at_ns", integer},
                                                     {"body", text},
                                                     {"sealed", blob},
                                                     {"previous", blob},
                                                     {"hash", blob},
                                                     {"own_session", integer, true}});
constexpr auto kTraces =
    std::to_array<TableColumn>({{"session", integer}, {"trial", integer}, {"box", blob}});
constexpr auto kKeys = std::to_array<TableColumn>({{"session", integer}, {"wrapped", blob}});
constexpr auto kSessions = std::to_array<TableColumn>({{"session", integer},
                                                       {"participant", text},
                                                       {"enrolment", integer},
                                                       {"state", text},
                                                       {"simulated", integer},
                                                       {"pilot", integer},
                                                       {"excluded", integer},
                                                       {"withdrawn", integer},
                                                       {"device", text},
                                                       {"replaced_by", text, true},
                                                       {"own_session", integer, true},
                                                       {"station", integer, false, "0"}});
constexpr auto kTrials = std::to_array<TableColumn>({{"session", integer},
                                                     {"trial", integer},
                                                     {"block", integer},
                                                     {"state", text},
                                                     {"presented_at_ns", integer},
                                                     {"contact_at_ns", integer, true},
                                                     {"valid", integer},
                                                     {"overruns", integer},
                                                     {"samples", integer},
                                                     {"rate_hz", real},
                                                     {"explorations", integer}});
constexpr auto kResponses = std::to_array<TableColumn>({{"session", integer},
                                                        {"trial", integer},
                                                        {"answered_at_ns", integer},
                                                        {"position", integer},
                                                        {"first_position", integer, true},
                                                        {"confidence", integer, true}});

constexpr auto kOfEvent = std::to_array<Names>({"session", "sequence"});
constexpr auto kOfSession = std::to_array<Names>({"session"});
constexpr auto kOfTrial = std::to_array<Names>({"session", "trial"});

constexpr auto kTakenOnce =
    std::to_array<UniqueIndex>({{"sessions_participant", "participant", "replaced_by IS NULL"},
                                {"sessions_enrolment", "enrolment", "replaced_by IS NULL"}});

constexpr auto kTrialsRefer = std::to_array<TableReference>({{kOfSession, "sessions"}});
constexpr auto kResponsesRefer = std::to_array<TableReference>({{kOfTrial, "trials"}});

constexpr auto kTables = std::to_array<TableDefinition>({
    {"events", kEvents, kOfEvent, true},
    {"traces", kTraces, kOfTrial, true},
    {"participant_keys", kKeys, kOfSession},
    {"sessions", kSessions, kOfSession, false, kTakenOnce},
    {"trials", kTrials, kOfTrial, false, {}, kTrialsRefer},
    {"responses", kResponses, kOfTrial, false, {}, kResponsesRefer},
});

}  // namespace

std::span<const TableDefinition> table_definitions() {
  return kTables;
}

}  // namespace touchtrial::store
