/// \file The SIMD target that a case asks for, forced while it runs.
#pragma once

#include <string>

namespace touchtrial::bench {

/// What runs where no case asks for anything else: a target of this machine, or "" for the best.
/// \throws std::invalid_argument if the machine does not have it
void choose_usual_target(const std::string& name);

/// Forces a target while it lives.
class ForcedTarget {
 public:
  /// \param name  of a target of this machine; "": the usual one
  explicit ForcedTarget(const std::string& name);
  ~ForcedTarget();
  ForcedTarget(const ForcedTarget&) = delete;
  ForcedTarget& operator=(const ForcedTarget&) = delete;

 private:
  bool forced_;
};

}  // namespace touchtrial::bench
