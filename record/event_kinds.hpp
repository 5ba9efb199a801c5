/// \file The table of event kinds. Names, sealing, the split of bodies and the data dictionary
/// follow from it.
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

/// Visits the members of an empty body.
using DescribeBody = void (*)(BodyIo& io);

template <typename Body>
void describe_body(BodyIo& io) {
  Body{}.describe(io);
}

struct EventKindRow {
  /// Details that most kinds do not have.
  struct Details {
    std::string_view text{};                ///< what the member `text` of a TextBody holds
    DescribeBody secret = nullptr;          ///< members of a sealed JSON text beside the body
    std::string_view secret_description{};  ///< of a sealed text of other form; empty: none
    bool in_safety_record = false;          ///< sealed with safety_key()
  };

  EventKind kind;
  std::string_view name;     ///< as stored: the enumerator with hyphens
  std::string_view meaning;  ///< one clause, for people
  DescribeBody body;
  /// Size of the sealed part after padding, in kSealedUnit. Answers and times fit into it, so that
  /// sizes reveal nothing.
  std::size_t sealed_units = 1;
  Details details{};
};

/// Every kind, in the order of EventKind.
[[nodiscard]] std::span<const EventKindRow> event_kinds();
[[nodiscard]] const EventKindRow& row_of(EventKind kind);

/// A member as the data dictionary lists it.
struct ListedMember {
  BodyIo::Member member;
  std::string type;                    ///< in words, with its range
  std::vector<ListedMember> within{};  ///< members of an object
};

[[nodiscard]] std::vector<ListedMember> members_of(DescribeBody describe);
/// The members of a kind's body.
[[nodiscard]] const std::vector<ListedMember>& members_of(EventKind kind);

}  // namespace touchtrial::record
