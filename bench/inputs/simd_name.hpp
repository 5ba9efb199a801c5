/// \file What processors' makers call a SIMD target.
#pragma once

#include <string>

namespace touchtrial::bench {

/// "AVX-512" for Highway's "AVX3" and its relatives; other names stay.
[[nodiscard]] inline std::string instruction_set_of(const std::string& target) {
  return target.starts_with("AVX3") ? "AVX-512" : target;
}

}  // namespace touchtrial::bench
