/// \file Exclusive use of a resource within this program.
#pragma once

#include "core/errors.hpp"

#include <atomic>
#include <string>

namespace touchtrial::device {

/// Reserves a resource that a vendor's library supports only once at a time. Any thread.
class ExclusiveUse {
 public:
  /// \param in_use  the resource's flag; must outlive this
  /// \param refusal  one line: why a second use is refused, and the remedy
  /// \throws DeviceError with `refusal` if it is in use
  ExclusiveUse(std::atomic<bool>& in_use, const std::string& refusal) : in_use_(in_use) {
    if (in_use_.exchange(true)) throw DeviceError(one_line(refusal));
  }
  ~ExclusiveUse() { in_use_.store(false); }
  ExclusiveUse(const ExclusiveUse&) = delete;
  ExclusiveUse& operator=(const ExclusiveUse&) = delete;

 private:
  std::atomic<bool>& in_use_;
};

}  // namespace touchtrial::device
