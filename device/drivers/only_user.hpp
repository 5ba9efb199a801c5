/// \file One user at a time, within this program, of what does not bear a second one.
#pragma once

#include "core/errors.hpp"

#include <atomic>
#include <string>

namespace touchtrial::device {

/// Holds a thing that a vendor's library serves once at a time. Any thread.
class OnlyUser {
 public:
  /// \param in_use  of that thing; must outlive this
  /// \param refusal  one line: why there is no second user, and the remedy
  /// \throws DeviceError in these words if there is one already
  OnlyUser(std::atomic<bool>& in_use, const std::string& refusal) : in_use_(in_use) {
    if (in_use_.exchange(true)) throw DeviceError(one_line(refusal));
  }
  ~OnlyUser() { in_use_.store(false); }
  OnlyUser(const OnlyUser&) = delete;
  OnlyUser& operator=(const OnlyUser&) = delete;

 private:
  std::atomic<bool>& in_use_;
};

}  // namespace touchtrial::device
