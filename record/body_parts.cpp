#include "record/body_parts.hpp"

#include "record/payload_io.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string_view>

namespace touchtrial::record {
namespace {

using Members = std::span<const std::string_view>;

constexpr auto kExcluded = std::to_array<std::string_view>({"after_outcomes", "session"});
constexpr auto kWithdrawn = std::to_array<std::string_view>({"kept", "not_erased", "session"});
constexpr auto kReplaced = std::to_array<std::string_view>({"by", "session"});
constexpr auto kRemarked = std::to_array<std::string_view>({"code", "session"});
constexpr auto kTrial = std::to_array<std::string_view>({"trial"});
constexpr auto kPractised = std::to_array<std::string_view>({"presentation", "round"});
constexpr auto kCode = std::to_array<std::string_view>({"code"});
constexpr auto kInterrupted =
    std::to_array<std::string_view>({"device_fault", "reason", "safety_fault", "trial"});
constexpr auto kResumed = std::to_array<std::string_view>({"after", "program_version", "trial"});
constexpr auto kClosed = std::to_array<std::string_view>({"answers", "complete", "one_key"});
constexpr auto kTraceStored =
    std::to_array<std::string_view>({"contact_ok", "force_ok", "overruns", "path_ok", "rate_hz",
                                     "servo", "speed_ok", "trace", "trial", "valid"});

/// The members that stay in clear; empty: all do.
std::optional<Members> clear_members(EventKind kind) {
  switch (kind) {
    case EventKind::participant_excluded:
      return kExcluded;
    case EventKind::participant_withdrawn:
      return kWithdrawn;
    case EventKind::participant_replaced:
      return kReplaced;
    case EventKind::participant_noted:
      return kRemarked;
    case EventKind::answered:
    case EventKind::paused:
      return kTrial;
    case EventKind::interrupted:
      return kInterrupted;
    case EventKind::practised:
      return kPractised;
    case EventKind::noted:
      return Members();
    case EventKind::stopped:
    case EventKind::deviated:
      return kCode;
    case EventKind::resumed:
      return kResumed;
    case EventKind::trace_stored:
      return kTraceStored;
    case EventKind::closed:
      return kClosed;
    default:
      return std::nullopt;
  }
}

nlohmann::json object_of(const std::string& text) {
  nlohmann::json object = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!object.is_object()) throw StoreError("the body is not a JSON object");
  return object;
}

}  // namespace

BodyParts split_body(EventKind kind, const std::string& body) {
  const std::optional<Members> clear = clear_members(kind);
  if (!clear) return {body, ""};
  nlohmann::json shown = nlohmann::json::object();
  nlohmann::json hidden = nlohmann::json::object();
  const nlohmann::json whole = object_of(body);
  for (const auto& [key, value] : whole.items()) {
    const bool is_clear = std::ranges::find(*clear, key) != clear->end();
    (is_clear ? shown : hidden)[key] = value;
  }
  return {shown.dump(), hidden.empty() ? "" : hidden.dump()};
}

std::string joined_body(const BodyParts& parts) {
  if (parts.hidden.empty()) return parts.clear;
  nlohmann::json whole = object_of(parts.clear);
  whole.update(object_of(parts.hidden));
  return whole.dump();
}

std::size_t sealed_padding(EventKind kind) {
  switch (kind) {
    case EventKind::resumed:
      return 2 * kSealedUnit;
    case EventKind::answered:
    case EventKind::practised:
      return 4 * kSealedUnit;
    case EventKind::trace_stored:
      return 16 * kSealedUnit;
    case EventKind::marked:
      return 32 * kSealedUnit;
    case EventKind::opened:
    case EventKind::interrupted:
    case EventKind::noted:
    case EventKind::paused:
    case EventKind::stopped:
    case EventKind::deviated:
    case EventKind::questioned:
    case EventKind::block_restarted:
    case EventKind::closed:
      return 8 * kSealedUnit;
    default:
      return kSealedUnit;  // the time alone
  }
}

}  // namespace touchtrial::record
