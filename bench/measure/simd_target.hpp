/// \file The SIMD targets of cases: their names, and how one is forced while a case runs.
#pragma once

#include <string>

namespace touchtrial::bench {

/// "AVX-512" for Highway's "AVX3" and its relatives; other names are unchanged.
[[nodiscard]] inline std::string instruction_set_of(const std::string& target) {
  return target.starts_with("AVX3") ? "AVX-512" : target;
}

/// Chooses the target of cases that name none.
/// \param name  a target of this machine; "" for the best
/// \throws std::invalid_argument if the machine does not have it
void choose_usual_target(const std::string& name);

/// Forces a target while this object lives.
class ForcedTarget {
 public:
  /// \param name  a target of this machine; "" for the usual one
  explicit ForcedTarget(const std::string& name);
  ~ForcedTarget();
  ForcedTarget(const ForcedTarget&) = delete;
  ForcedTarget& operator=(const ForcedTarget&) = delete;

 private:
  bool forced_;
};

}  // namespace touchtrial::bench
