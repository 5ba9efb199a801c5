#include "record/event.hpp"

#include "record/damage.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace touchtrial::record {
namespace {

constexpr std::string_view kStatementPrefix = "touchtrial event 1";

/// The signed text of an event; its hash covers the chain up to it.
auto statement_of(const Event& event) {
  std::array<std::uint8_t, kStatementPrefix.size() + Digest{}.size()> statement{};
  std::ranges::copy(event.hash, std::ranges::copy(kStatementPrefix, statement.begin()).out);
  return statement;
}

}  // namespace

bool belongs_to_file_chain(EventKind kind) {
  return kind < EventKind::opened;
}

Digest event_hash(const Event& event) {
  return FieldHasher(HashFunction::blake2b)
      .add(std::int64_t{event.own_session()})
      .add(event.sequence)
      .add(name_of(event.kind))
      .add(std::int64_t{event.at.count()})
      .add(event.body)
      .add(event.sealed)
      .add(event.previous)
      .finish();
}

Event next_on_file(const Event* last, EventKind kind, std::chrono::nanoseconds at, std::string body,
                   Bytes sealed) {
  Event event{.session = 0,
              .sequence = last == nullptr ? 0 : last->sequence + 1,
              .kind = kind,
              .at = at,
              .body = std::move(body),
              .sealed = std::move(sealed),
              .previous = last == nullptr ? Digest{} : last->hash,
              .hash = {}};
  event.hash = event_hash(event);
  return event;
}

Event signed_event(Event event, const Signer& signer) {
  const Signature signature = signer.sign(statement_of(event));
  event.signature.assign(signature.begin(), signature.end());
  return event;
}

bool is_event_signed_by(const PublicKey& signer, const Event& event) {
  return is_signed_by(signer, statement_of(event), event.signature);
}

ChainLink ChainLink::after(const Event& last) {
  ChainLink link(last.session, last.own_session());
  link.length_ = last.sequence + 1;
  link.head_ = last.hash;
  return link;
}

std::optional<std::string> ChainLink::link_fault(const Event& next) const {
  if (next.session != session_ || next.own_session() != own_session_) {
    return "the event belongs to another chain [other-chain]";
  }
  // Makes the representation of an event unique.
  if (next.renumbered_from == next.session) return "the event repeats its own number [own-number]";
  if (next.sequence > length_) {
    return "sequence gap: event " + std::to_string(length_) + " is missing [sequence-gap]";
  }
  if (next.sequence < length_) return "the sequence number repeats [repeated-sequence]";
  if (next.previous != head_) {
    return length_ == 0 ? "previous is not zero in the first event [broken-link]"
                        : "previous does not match the hash of the previous event [broken-link]";
  }
  if (next.hash != event_hash(next))
    return "the hash of the event does not match its content [altered-event]";
  if (belongs_to_file_chain(next.kind) != (session_ <= 0)) {
    return "an event of kind '" + std::string(name_of(next.kind)) + "' does not belong here";
  }
  if (session_ > 0 && next.at.count() != 0)
    return "the time of the event is not sealed [time-in-clear]";
  if (session_ > 0 && !next.signature.empty()) return "an event of a session has a signature";
  return std::nullopt;
}

void ChainLink::extend(const Event& next) {
  if (const auto fault = link_fault(next)) {
    throw EventFault(session_, std::min(next.sequence, length_), *fault);
  }
  ++length_;
  head_ = next.hash;
}

}  // namespace touchtrial::record
