/// \file Seeded random numbers, the same on every platform and with every standard library.
#pragma once

#include "core/hash.hpp"

#include <cstdint>
#include <random>
#include <span>
#include <string_view>
#include <utility>

namespace touchtrial {

/// A stream of random numbers. The engine is std::mt19937_64, whose output the C++ standard fixes;
/// the distributions are this program's or Boost.Random's, because the standard library's differ
/// between implementations. Not thread-safe; give each thread its own stream.
class RandomStream {
 public:
  /// Each (seed, purpose, index) gives a different stream. Streams of different purposes are
  /// unrelated, so an additional draw from one leaves the others unchanged.
  RandomStream(std::uint64_t seed, std::string_view purpose, std::uint64_t index = 0);
  /// The same from 32 secret bytes instead of a seed, for draws that must be unpredictable. Draws
  /// of one stream reveal nothing about another.
  RandomStream(const Digest& secret, std::string_view purpose, std::uint64_t index = 0);

  /// The next 64 random bits.
  [[nodiscard]] std::uint64_t bits() { return engine_(); }

  /// A whole number in [0, bound), each equally likely (by rejection).
  /// \param bound  >= 1
  [[nodiscard]] std::uint64_t below(std::uint64_t bound) {
    // Rejects the lowest 2^64 mod bound draws, so that every number is equally likely. That count
    // is less than bound, so a draw >= bound needs no check, and few draws need the first division.
    std::uint64_t draw = bits();
    if (draw < bound) {
      const std::uint64_t excess = (0 - bound) % bound;
      while (draw < excess) draw = bits();
    }
    return draw % bound;
  }

  /// A number in [0, 1) with 53 random bits.
  [[nodiscard]] double uniform() { return static_cast<double>(bits() >> 11U) * 0x1.0p-53; }
  /// A number in [low, high).
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// A standard normal number.
  [[nodiscard]] double normal();

 private:
  std::mt19937_64 engine_;
};

/// Shuffles the elements; every order is equally likely (Fisher-Yates, from the back).
template <typename T>
void shuffle(std::span<T> elements, RandomStream& random) {
  for (std::size_t count = elements.size(); count > 1; --count) {
    std::swap(elements[count - 1], elements[static_cast<std::size_t>(random.below(count))]);
  }
}

}  // namespace touchtrial
