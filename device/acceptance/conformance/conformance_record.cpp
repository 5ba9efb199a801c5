#include "core/named.hpp"
#include "device/acceptance/conformance/conformance.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace touchtrial::device {
namespace {

using Id = ConformanceId;

struct CheckWords {
  Id id;
  std::string_view name;
  std::string_view meaning;
  bool of_plugin = false;
};

constexpr std::array<CheckWords, 21> kCheckWords = {{
    {Id::library, "interface", "The library loads and has version, size, functions and a name.",
     true},
    {Id::opening, "opens", "The device opens."},
    {Id::description, "describes itself", "Force, rate, stiffness and workspace are in range."},
    {Id::memory, "keeps to its memory", "Writes no further than the structures it is given.", true},
    {Id::staying, "stays up", "Reports no fault while nothing is wrong."},
    {Id::numbering, "numbers readings", "A new number for each new reading, and never a smaller."},
    {Id::values, "plausible values",
     "Positions and velocities are numbers that a device can have."},
    {Id::workspace, "inside its workspace", "Positions lie in the described workspace, or nearly."},
    {Id::velocity, "velocity fits position", "The velocity is the change of position, in mm/s."},
    {Id::rate, "rate", "New readings come at half the described rate or more, and 500 a second."},
    {Id::gaps, "no gaps", "No reading is older than 10 ms: the safety chain would end the run."},
    {Id::unready_zero, "zero before ready", "No force on the motors before the device is ready."},
    {Id::rest_zero, "zero when told zero", "No force on the motors while the servo sends zero."},
    {Id::pushing, "sends what it is told", "The motors are told the servo's force, on each axis."},
    {Id::lapsing, "zero without a servo", "The force ends 10 ms after the servo's last write."},
    {Id::halting, "zero after halt", "The force ends at once, and until a person re-arms."},
    {Id::rearming, "force after re-arming", "After that, forces pass again."},
    {Id::closing_zero, "zero after closing", "A closed device is left without force."},
    {Id::opening_twice, "opened twice", "A second opening is refused, or leaves the first intact."},
    {Id::reopening, "opens again", "After closing it opens again, as the same device."},
    {Id::calls, "short calls",
     "sample and force take less than half a period (99 %), and never 10 ms.", true},
}};

}  // namespace

void ConformanceRecord::pass(ConformanceId id, std::string finding) {
  if (!failed(id)) entries_[id] = {ConformanceOutcome::passed, std::move(finding)};
}

void ConformanceRecord::fail(ConformanceId id, std::string finding) {
  if (!failed(id)) entries_[id] = {ConformanceOutcome::failed, std::move(finding)};
}

void ConformanceRecord::leave(ConformanceId id, std::string reason) {
  entries_.try_emplace(id, Entry{ConformanceOutcome::not_observed, std::move(reason)});
}

void ConformanceRecord::leave_rest(const std::string& reason, bool of_plugin) {
  for (const CheckWords& words : kCheckWords) {
    if (of_plugin || !words.of_plugin) leave(words.id, reason);
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

std::vector<ConformanceCheck> ConformanceRecord::checks(bool of_plugin) const {
  std::vector<ConformanceCheck> all;
  for (const CheckWords& words : kCheckWords) {
    const auto found = entries_.find(words.id);
    const bool is_shown = found != entries_.end() || !words.of_plugin || of_plugin;
    if (!is_shown) continue;
    const Entry entry = found == entries_.end() ? Entry{} : found->second;
    all.push_back({words.id, words.name, words.meaning, entry.outcome, entry.finding});
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
