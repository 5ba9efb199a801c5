/// \file Whole numbers of any size, and uniform draws among them. For sources only.
#pragma once

#include "core/random.hpp"

#include <cstdint>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

namespace touchtrial::design {

using BigCount = boost::multiprecision::cpp_int;

/// A number in [0, bound), each equally likely (by rejection: less than two tries on average).
/// \pre bound >= 1
[[nodiscard]] inline BigCount draw_below(const BigCount& bound, RandomStream& random) {
  constexpr unsigned kWord = 64;
  if (bound == 1) return 0;
  const unsigned bits = boost::multiprecision::msb(BigCount(bound - 1)) + 1;
  const unsigned words = (bits + kWord - 1) / kWord;
  while (true) {
    std::vector<std::uint64_t> drawn(words);
    for (std::uint64_t& word : drawn) word = random.bits();
    BigCount number;
    boost::multiprecision::import_bits(number, drawn.begin(), drawn.end());
    number >>= words * kWord - bits;
    if (number < bound) return number;
  }
}

}  // namespace touchtrial::design
