#include "protocols/store/body_parts.hpp"

#include "protocols/store/payload_io.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string_view>

namespace touchtrial::store {
namespace {

using Members = std::span<const std::string_view>;

constexpr auto kAnswered = std::to_array<std::string_view>({"trial"});
constexpr auto kPractised = std::to_array<std::string_view>({"presentation", "round"});
constexpr auto kDeviated = std::to_array<std::string_view>({"code"});
constexpr auto kResumed = std::to_array<std::string_view>({"after", "program_version"});
constexpr auto kTraceStored = std::to_array<std::string_view>(
    {"overruns", "rate_hz", "seconds", "servo", "trace", "trial", "valid"});

/// The members that stay in clear; empty: all do.
std::optional<Members> clear_members(EventKind kind) {
  switch (kind) {
    case EventKind::answered:
      return kAnswered;
    case EventKind::practised:
      return kPractised;
    case EventKind::noted:
      return Members();
    case EventKind::deviated:
      return kDeviated;
    case EventKind::resumed:
      return kResumed;
    case EventKind::trace_stored:
      return kTraceStored;
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
    case EventKind::opened:
    case EventKind::interrupted:
    case EventKind::noted:
    case EventKind::deviated:
    case EventKind::questioned:
    case EventKind::block_restarted:
    case EventKind::closed:
      return 8 * kSealedUnit;
    default:
      return kSealedUnit;  // the time alone
  }
}

}  // namespace touchtrial::store
