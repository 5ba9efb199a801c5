#include "protocols/store/chain_link.hpp"

namespace touchtrial::store {

ChainLink ChainLink::after(const Event& last) {
  ChainLink link(last.session, last.own_session());
  link.length_ = last.sequence;
  link.extend(last);
  return link;
}

std::optional<std::string> ChainLink::broken_by(const Event& next) const {
  if (next.session != session_ || next.own_session() != own_session_) {
    return "the event belongs to another chain";
  }
  if (next.sequence > length_) {
    return "sequence gap: event " + std::to_string(length_) + " is missing";
  }
  if (next.sequence < length_) return "the sequence number repeats";
  if (next.previous != head_) {
    return length_ == 0 ? "previous is not zero in the first event"
                        : "previous does not match the hash of the event before";
  }
  if (next.hash != event_hash(next)) return "the hash of the event does not match its content";
  if (belongs_to_file_chain(next.kind) != (session_ <= 0)) {
    return "an event of kind '" + std::string(name_of(next.kind)) + "' does not belong here";
  }
  // The file's chain has the clock on the wall, which may be set back.
  if (session_ > 0 && next.at < last_at_) return "the time is before that of the event before";
  return std::nullopt;
}

void ChainLink::extend(const Event& next) {
  ++length_;
  head_ = next.hash;
  last_at_ = next.at;
}

}  // namespace touchtrial::store
