/// \file Where a chain ends, and whether an event continues it.
#pragma once

#include "protocols/store/event.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace touchtrial::store {

/// The growing end of one chain. What events mean is the business of fold; this is about the chain.
class ChainLink {
 public:
  /// \param session  0 for the file's chain, -1, -2, ... for a collected station's
  explicit ChainLink(int session) : ChainLink(session, std::max(session, 0)) {}
  /// \param own_session  Event::own_session of its events
  ChainLink(int session, int own_session) : session_(session), own_session_(own_session) {}

  /// The end of a chain that is stored already. \param last  its last event
  [[nodiscard]] static ChainLink after(const Event& last);

  /// \return why `next` cannot follow, or nothing if it does
  [[nodiscard]] std::optional<std::string> broken_by(const Event& next) const;

  /// \pre !broken_by(next)
  void extend(const Event& next);

  [[nodiscard]] std::int64_t length() const noexcept { return length_; }
  /// Hash of the last event; zeros before the first.
  [[nodiscard]] const Digest& head() const noexcept { return head_; }

 private:
  int session_;
  int own_session_;
  std::int64_t length_ = 0;
  Digest head_{};
  std::chrono::nanoseconds last_at_{0};
};

}  // namespace touchtrial::store
