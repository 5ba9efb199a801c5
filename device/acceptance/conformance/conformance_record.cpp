#include "core/named.hpp"
#include "device/acceptance/conformance/conformance.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace touchtrial::device {
namespace {

using Id = ConformanceId;

struct CheckText {
  Id id;
  std::string_view name;
  std::string_view meaning;
  bool with_plugin_checks = false;
};

constexpr std::array<CheckText, 21> kCheckTexts = {{
    {Id::library, "interface", "The library loads and has version, size, functions and a name.",
     true},
    {Id::opening, "opens", "The device opens."},
    {Id::description, "describes itself", "Force, rate, stiffness and workspace are in range."},
    {Id::memory, "keeps to its memory", "Does not write beyond the structures it is given.", true},
    {Id::staying, "stays up", "Reports no fault without a cause."},
    {Id::numbering, "numbers readings", "Each new reading has a larger number."},
    {Id::values, "plausible values", "Positions and velocities are possible for a device."},
    {Id::workspace, "inside its workspace", "Positions are in or near the described workspace."},
    {Id::velocity, "velocity fits position", "The velocity is the change of position, in mm/s."},
    {Id::rate, "rate", "At least half the described rate and 500 new readings per second."},
    {Id::gaps, "no gaps", "No reading is older than 10 ms: the safety chain would end the run."},
    {Id::unready_zero, "zero before ready", "No force on the motors before the device is ready."},
    {Id::rest_zero, "zero when told zero", "No force on the motors while the servo sends zero."},
    {Id::pushing, "sends what it is told", "The motors receive the servo's force on each axis."},
    {Id::lapsing, "zero without a servo", "The force ends 10 ms after the servo's last write."},
    {Id::halting, "zero after halt", "The force ends at once and stays zero until re-arming."},
    {Id::rearming, "force after re-arming", "After that, forces pass again."},
    {Id::closing_zero, "zero after closing", "A closed device exerts no force."},
    {Id::opening_twice, "opened twice", "A second opening is refused, or leaves the first intact."},
    {Id::reopening, "opens again", "After closing, it reopens as the same device."},
    {Id::calls, "short calls",
     "sample and force together take less than half a period (99 %), and always less than 10 ms.",
     true},
}};

}  // namespace

void ConformanceRecord::pass(ConformanceId id, std::string finding) {
  if (!failed(id)) entries_[id] = {ConformanceOutcome::passed, std::move(finding)};
}

void ConformanceRecord::fail(ConformanceId id, std::string finding) {
  if (!failed(id)) entries_[id] = {ConformanceOutcome::failed, std::move(finding)};
}

void ConformanceRecord::set_not_observed(ConformanceId id, std::string reason) {
  entries_.try_emplace(id, Entry{ConformanceOutcome::not_observed, std::move(reason)});
}

void ConformanceRecord::set_remaining_not_observed(const std::string& reason,
                                                   bool with_plugin_checks) {
  for (const CheckText& text : kCheckTexts) {
    if (with_plugin_checks || !text.with_plugin_checks) set_not_observed(text.id, reason);
  }
}

bool ConformanceRecord::failed(ConformanceId id) const {
  const auto found = entries_.find(id);
  return found != entries_.end() && found->second.outcome == ConformanceOutcome::failed;
}

void ConformanceRecord::add(const std::vector<ConformanceCheck>& checks) {
  for (const ConformanceCheck& check : checks) {
    if (!failed(check.id)) entries_[check.id] = {check.outcome, check.finding};
  }
}

std::vector<ConformanceCheck> ConformanceRecord::checks(bool with_plugin_checks) const {
  std::vector<ConformanceCheck> all;
  for (const CheckText& text : kCheckTexts) {
    const auto found = entries_.find(text.id);
    const bool is_shown = found != entries_.end() || !text.with_plugin_checks || with_plugin_checks;
    if (!is_shown) continue;
    const Entry entry = found == entries_.end() ? Entry{} : found->second;
    all.push_back({text.id, text.name, text.meaning, entry.outcome, entry.finding});
  }
  return all;
}

bool conforms(const std::vector<ConformanceCheck>& checks) noexcept {
  const bool none_failed = std::none_of(
      checks.begin(), checks.end(),
      [](const ConformanceCheck& check) { return check.outcome == ConformanceOutcome::failed; });
  return none_failed &&
         std::any_of(checks.begin(), checks.end(), [](const ConformanceCheck& check) {
           return check.id == Id::numbering && check.outcome == ConformanceOutcome::passed;
         });
}

std::string_view name_of(ConformanceOutcome outcome) noexcept {
  using enum ConformanceOutcome;
  static constexpr auto kNames = std::to_array<Named<ConformanceOutcome>>(
      {{"passed", passed}, {"failed", failed}, {"not_observed", not_observed}});
  return name_in(kNames, outcome);
}

}  // namespace touchtrial::device
