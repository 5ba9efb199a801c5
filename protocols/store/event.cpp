#include "protocols/store/event.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace touchtrial::store {
namespace {

constexpr std::array<std::pair<EventKind, std::string_view>, 30> kNames = {{
    {EventKind::study_committed, "study-committed"},
    {EventKind::session_opened, "session-opened"},
    {EventKind::session_closed, "session-closed"},
    {EventKind::participant_excluded, "participant-excluded"},
    {EventKind::participant_withdrawn, "participant-withdrawn"},
    {EventKind::study_closed, "study-closed"},
    {EventKind::study_unblinded, "study-unblinded"},
    {EventKind::participant_replaced, "participant-replaced"},
    {EventKind::participant_noted, "participant-noted"},
    {EventKind::opened, "opened"},
    {EventKind::calibrated, "calibrated"},
    {EventKind::instructed, "instructed"},
    {EventKind::practised, "practised"},
    {EventKind::presented, "presented"},
    {EventKind::first_contact, "first-contact"},
    {EventKind::answered, "answered"},
    {EventKind::interrupted, "interrupted"},
    {EventKind::timed_out, "timed-out"},
    {EventKind::trace_stored, "trace-stored"},
    {EventKind::break_taken, "break-taken"},
    {EventKind::paused, "paused"},
    {EventKind::stopped, "stopped"},
    {EventKind::noted, "noted"},
    {EventKind::ticked, "ticked"},
    {EventKind::deviated, "deviated"},
    {EventKind::questioned, "questioned"},
    {EventKind::explored_again, "explored-again"},
    {EventKind::block_restarted, "block-restarted"},
    {EventKind::resumed, "resumed"},
    {EventKind::closed, "closed"},
}};
static_assert(kNames.size() == static_cast<std::size_t>(EventKind::closed) + 1);

}  // namespace

std::string_view name_of(EventKind kind) {
  const auto index = static_cast<std::size_t>(kind);
  return index < kNames.size() ? kNames[index].second : std::string_view("unknown");
}

std::optional<EventKind> event_kind_from_name(std::string_view name) {
  const auto* const found = std::find_if(kNames.begin(), kNames.end(),
                                         [&](const auto& entry) { return entry.second == name; });
  if (found == kNames.end()) return std::nullopt;
  return found->first;
}

bool belongs_to_file_chain(EventKind kind) {
  return kind <= EventKind::participant_noted;
}

Digest event_hash(const Event& event) {
  return FieldHasher()
      .add(std::int64_t{event.own_session()})
      .add(event.sequence)
      .add(name_of(event.kind))
      .add(std::int64_t{event.at.count()})
      .add(event.body)
      .add(event.sealed)
      .add(event.previous)
      .finish();
}

}  // namespace touchtrial::store
