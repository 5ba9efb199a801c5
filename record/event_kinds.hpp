/// \file What distinguishes the kinds of events: a row for each, from which names, sealing, the
/// split of bodies and the data dictionary follow.
#pragma once

#include "record/body_io.hpp"
#include "record/event.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::record {

/// The sealed parts of all events are padded to a multiple of this many bytes.
inline constexpr std::size_t kSealedUnit = 32;

/// Visits the members of a body that has no values.
using DescribeBody = void (*)(BodyIo& io);

template <typename Body>
void describe_body(BodyIo& io) {
  Body{}.describe(io);
}

struct EventKindRow {
  /// What most kinds lack.
  struct More {
    std::string_view text{};                ///< what the member `text` of a TextBody holds
    DescribeBody secret = nullptr;          ///< of a sealed text beside the body, if it has members
    std::string_view secret_description{};  ///< what else it is; empty: there is none
    bool in_safety_record = false;          ///< sealed for safety_key()
  };

  EventKind kind;
  std::string_view name;     ///< as stored: the enumerator with hyphens
  std::string_view meaning;  ///< one clause, for people
  DescribeBody body;
  /// Padding of the sealed part in kSealedUnit. Answers and times fit into it, so sizes reveal
  /// nothing.
  std::size_t sealed_units = 1;
  More more{};
};

/// Every kind, in the order of EventKind.
[[nodiscard]] std::span<const EventKindRow> event_kinds();
[[nodiscard]] const EventKindRow& row_of(EventKind kind);

/// A member as the data dictionary lists it.
struct ListedMember {
  BodyIo::Member member;
  std::string type;                    ///< in words, with its range
  std::vector<ListedMember> within{};  ///< of an object
};

[[nodiscard]] std::vector<ListedMember> members_of(DescribeBody describe);
/// The members of a kind's body.
[[nodiscard]] const std::vector<ListedMember>& members_of(EventKind kind);

}  // namespace touchtrial::record
